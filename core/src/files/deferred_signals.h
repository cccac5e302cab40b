#pragma once

#include "numerics/detail.h"

namespace skinglow::detail {

/// While it lives, requests to end (SIGINT, SIGTERM, SIGHUP) wait; then they take effect. May live
/// on many threads at once.
class DeferredSignals {
  public:
    DeferredSignals();
    ~DeferredSignals();
    DeferredSignals(const DeferredSignals&) = delete;
    DeferredSignals& operator=(const DeferredSignals&) = delete;
};

}  // namespace skinglow::detail
