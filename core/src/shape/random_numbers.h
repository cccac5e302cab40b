#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Well-mixed bits of a number: the finalizer of SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA 2014).
inline std::uint64_t mixed_bits(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

/// In [0, 1), from a number.
inline float uniform_of(std::uint64_t x) {
    return static_cast<float>(mixed_bits(x) >> 40U) * 0x1p-24F;
}

/// Points of the unit cube of five dimensions: an even first coordinate, and a rank-1 sequence of four (M.
/// Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), shifted as a whole by the seed.
class Lattice5 {
  public:
    Lattice5(int count, std::uint64_t seed) : count_(count) {
        for (std::size_t d = 0; d < 5; ++d)
            shift_[d] = static_cast<double>(mixed_bits(5 * seed + d) >> 11U) * 0x1p-53;
    }
    std::array<float, 5> at(int i) const {
        constexpr double base = 1.16730397826141868426;  // the real root of x^5 = x + 1
        constexpr std::array<double, 5> step = {0, 1 / base, 1 / (base * base), 1 / (base * base * base),
                                                1 / (base * base * base * base)};
        std::array<float, 5> result{};
        for (std::size_t d = 0; d < 5; ++d) {
            const double x = shift_[d] + (d == 0 ? static_cast<double>(i) / count_ : i * step[d]);
            result[d] = static_cast<float>(std::min(x - std::floor(x), 1 - 0x1p-24));
        }
        return result;
    }

  private:
    int count_;
    std::array<double, 5> shift_{};
};

}  // namespace skinglow::detail
