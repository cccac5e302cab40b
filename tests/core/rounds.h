#pragma once

#include <algorithm>

namespace skinglow {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int rounds_share = 4;
#else
inline constexpr int rounds_share = 1;
#endif

/// The rounds of a property under random input: a quarter where sanitizers watch, which make each several times as long.
/// Numbers are judged by all of them in the build that ships; the sanitizers judge the code that the rounds run through.
constexpr int rounds(int all) {
    return std::max(1, all / rounds_share);
}

}  // namespace skinglow
