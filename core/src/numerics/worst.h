#pragma once

#include <cmath>

#include "numerics/detail.h"

namespace skinglow::detail {

/// The larger of two errors. Not a number is the worst of all, where std::max would pass over it.
inline double worst(double a, double b) {
    return std::isnan(a) || a >= b ? a : b;
}

}  // namespace skinglow::detail
