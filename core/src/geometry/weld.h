#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A list of points with each different one kept once, in the order of first appearance.
struct Weld {
    std::vector<std::uint32_t> first;  ///< for each different point, its first entry in the list
    std::vector<std::uint32_t> index;  ///< for each entry of the list, its point's place in `first`
};

/// Hash of a GLM vector of doubles; equal for vectors that compare equal.
template <typename Vector>
std::size_t hash_of(const Vector& value) {
    std::uint64_t hash = 0;
    for (int k = 0; k < value.length(); ++k) {
        const auto bits = std::bit_cast<std::uint64_t>(value[k] + 0.0);  // + 0: minus zero equals zero
        hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;                    // 2^64 over the golden ratio
        hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
}

/// Finds entries that are exactly equal. Hash table with linear probing, at most half full.
/// @param values  GLM vectors of doubles, no NaN, fewer than 2^32
template <typename Vector>
Weld weld(std::span<const Vector> values) {
    constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();
    Weld result;
    result.index.reserve(values.size());
    const std::size_t mask = std::bit_ceil(2 * values.size() + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, empty);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::size_t slot = hash_of(values[i]) & mask;
        while (table[slot] != empty && values[result.first[table[slot]]] != values[i])
            slot = (slot + 1) & mask;
        if (table[slot] == empty) {
            table[slot] = static_cast<std::uint32_t>(result.first.size());
            result.first.push_back(static_cast<std::uint32_t>(i));
        }
        result.index.push_back(table[slot]);
    }
    return result;
}

}  // namespace skinglow::detail
