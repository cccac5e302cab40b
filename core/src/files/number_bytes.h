#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A number from its bytes in a file, whatever the machine's own byte order.
template <class Number, bool big_endian>
double load_number(const char* bytes) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), bytes, raw.size());
    if constexpr (big_endian != (std::endian::native == std::endian::big))
        std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
}

}  // namespace skinglow::detail
