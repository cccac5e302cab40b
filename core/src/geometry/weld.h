#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "numerics/huge_pages.h"

namespace skinglow::detail {

/// A list of points with each different one kept once, in the order of first appearance.
struct Weld {
    std::vector<std::uint32_t> first;  ///< for each different point, its first entry in the list
    std::vector<std::uint32_t> index;  ///< for each entry of the list, the index of its point in `first`
};

/// Hash of a GLM vector of doubles; equal for vectors that compare equal.
template <typename Vector>
std::uint32_t hash_of(const Vector& value) {
    constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;  // 2^64 over the golden ratio
    std::uint64_t hash = 0;
    for (int k = 0; k < value.length(); ++k) {
        const auto bits = std::bit_cast<std::uint64_t>(value[k] + 0.0);  // + 0: minus zero equals zero
        hash = (hash ^ bits) * golden;
        hash ^= hash >> 32U;
    }
    return static_cast<std::uint32_t>(hash * golden >> 32U);
}

/// Entries that may equal another one, ascending: all that do, and about one in ten of those that do not. Each has a
/// slot by its hash, of two bits: taken, and taken again. Eight slots an entry fit into a cache where a table of
/// entries does not.
template <typename Vector>
std::vector<std::uint32_t> possibly_equal(std::span<const Vector> values) {
    constexpr std::size_t slots = 32;  // of a word
    const std::size_t mask = std::bit_ceil(8 * values.size() + slots) - 1;
    std::vector<std::uint64_t> words((mask + 1) / slots);
    std::vector<std::uint32_t> hashes;
    reserve_huge(hashes, values.size());
    hashes.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        hashes[i] = hash_of(values[i]);
        std::uint64_t& word = words[(hashes[i] & mask) / slots];
        const std::uint64_t taken = std::uint64_t{1} << 2 * (hashes[i] % slots);
        word |= taken | (word & taken) << 1U;
    }
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < hashes.size(); ++i) {
        const std::uint64_t word = words[(hashes[i] & mask) / slots];
        if ((word >> 2 * (hashes[i] % slots) & 2U) != 0) found.push_back(static_cast<std::uint32_t>(i));
    }
    return found;
}

/// An entry that equals an earlier one.
struct Repeated {
    std::uint32_t entry;
    std::uint32_t first;  ///< the first of its equals
};

/// Finds entries that exactly equal earlier ones, ascending: those that may do are put into a hash table with linear
/// probing, at most half full.
/// @param values  GLM vectors of doubles, no NaN, fewer than 2^32
template <typename Vector>
std::vector<Repeated> repeated_entries(std::span<const Vector> values) {
    constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();
    const std::vector<std::uint32_t> candidates = possibly_equal(values);
    const std::size_t mask = std::bit_ceil(2 * candidates.size() + 1) - 1;
    std::vector<std::uint32_t> table;
    reserve_huge(table, mask + 1);
    table.resize(mask + 1, empty);
    std::vector<Repeated> found;
    // A block's slots are looked up before any is filled: these look-ups do not wait for each other.
    constexpr std::size_t block = 64;
    std::array<std::size_t, block> slots{};
    std::array<std::uint32_t, block> entries{};
    for (std::size_t begin = 0; begin < candidates.size(); begin += block) {
        const std::size_t count = std::min(block, candidates.size() - begin);
        for (std::size_t k = 0; k < count; ++k) {
            slots[k] = hash_of(values[candidates[begin + k]]) & mask;
            entries[k] = table[slots[k]];
        }
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t candidate = candidates[begin + k];
            std::size_t slot = slots[k];
            std::uint32_t entry = entries[k] != empty ? entries[k] : table[slot];
            while (entry != empty && values[entry] != values[candidate]) {
                slot = (slot + 1) & mask;
                entry = table[slot];
            }
            if (entry == empty) {
                table[slot] = candidate;
            } else {
                found.push_back({candidate, entry});
            }
        }
    }
    return found;
}

/// The list without its repeated entries.
/// @param count  entries of the list
inline Weld keep_once(std::size_t count, const std::vector<Repeated>& repeated) {
    Weld result;
    result.first.reserve(count - repeated.size());
    result.index.reserve(count);
    auto next = repeated.begin();
    for (std::uint32_t i = 0; i < count; ++i) {
        if (next != repeated.end() && next->entry == i) {
            result.index.push_back(result.index[next->first]);
            ++next;
        } else {
            result.index.push_back(static_cast<std::uint32_t>(result.first.size()));
            result.first.push_back(i);
        }
    }
    return result;
}

/// @param values  as repeated_entries
template <typename Vector>
Weld weld(std::span<const Vector> values) {
    return keep_once(values.size(), repeated_entries(values));
}

}  // namespace skinglow::detail
