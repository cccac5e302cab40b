#pragma once

/// Private parts live in skinglow::detail; code of the library names them without it. Only private headers
/// include this, so nothing of it reaches a user of the installed ones.
namespace skinglow::detail {}
namespace skinglow {
using namespace detail;  // NOLINT(google-build-using-namespace)
}  // namespace skinglow
