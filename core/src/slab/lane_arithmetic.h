#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "slab/thickness_kernel.h"

// What the kernel does in every lane alike. All loops over lanes are innermost and of fixed length, so that
// they become vector instructions of whichever processor the caller, into which they are inlined, is compiled
// for.
#if defined(__GNUC__)
#define SKINGLOW_INLINE inline __attribute__((always_inline))
#else
#define SKINGLOW_INLINE inline
#endif

namespace skinglow::slab {

// exp(x) and exp(x) - 1, both to rounding, for -700 <= x <= 0; written out so that the compiler can work on
// all lanes at once, which it cannot with calls of the library's. x = n ln 2 + r, Taylor series of exp(r)
// - 1.
struct Exponential {
    double value;
    double minus_one;
};
SKINGLOW_INLINE Exponential exponential(double x) {
    constexpr double shift =
        6755399441055744.0;  // 1.5 * 2^52: adding it leaves the nearest integer in the low bits
    constexpr double ln2_high = 6.93147180369123816490e-01;  // two parts, so that n ln 2 is exact enough
    constexpr double ln2_low = 1.90821492927058770002e-10;
    const double shifted = x * 1.44269504088896340736 + shift;
    const double n = shifted - shift;
    const double r = (x - n * ln2_high) - n * ln2_low;
    double series = 1.0 / 6227020800;
    series = series * r + 1.0 / 479001600;
    series = series * r + 1.0 / 39916800;
    series = series * r + 1.0 / 3628800;
    series = series * r + 1.0 / 362880;
    series = series * r + 1.0 / 40320;
    series = series * r + 1.0 / 5040;
    series = series * r + 1.0 / 720;
    series = series * r + 1.0 / 120;
    series = series * r + 1.0 / 24;
    series = series * r + 1.0 / 6;
    series = series * r + 1.0 / 2;
    series = series * r * r + r;
    // The exponent bits of 2^n.
    const auto bits = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52U;
    const auto power = std::bit_cast<double>(bits);
    return {power + power * series, (power - 1) + power * series};
}

// Numbers of one unknown, one per lane.
SKINGLOW_INLINE std::size_t triangle(std::size_t i, std::size_t j) {
    return (i * (i + 1) / 2 + j) * lanes;
}

// k tanh(k d / 2), k coth(k d / 2) and k / sinh(k d) of every mode and lane.
struct Factors {
    double* symmetric;
    double* antisymmetric;
    double* through;
};
SKINGLOW_INLINE void fill_factors(std::size_t n, const double* decay, double attenuation,
                                  const double* thickness, Factors factors) {
    constexpr double deepest = 700;  // exp(-700) is near the smallest number there is
    // Light beyond the critical angle meets no load at either face: only the layer's own k tanh(k d / 2)
    // keeps its pivots above rounding. So a layer is never thinner than 1e-11 of its fastest mode's length,
    // which changes T by as much. Where the fast modes are left out, the slowest alone, without absorption
    // near 0, must not set that length: the attenuation does.
    double fastest = attenuation;
    for (std::size_t i = 0; i < n; ++i) fastest = decay[i] > fastest ? decay[i] : fastest;
    const double thinnest = fastest > 1e-250 ? 1e-11 / fastest : 1e-200;
    for (std::size_t i = 0; i < n; ++i) {
        const double k = decay[i];
        for (std::size_t w = 0; w < lanes; ++w) {
            const double d = thickness[w] > thinnest ? thickness[w] : thinnest;
            const double depth = k * d < deepest ? k * d : deepest;
            const Exponential passed = exponential(-depth);
            const double reach = depth > 1e-290 ? -passed.minus_one / k : d;
            const double sum = 1 + passed.value;
            factors.symmetric[i * lanes + w] = -k * passed.minus_one / sum;
            factors.antisymmetric[i * lanes + w] = sum / reach;
            factors.through[i * lanes + w] = depth < deepest ? 2 * passed.value / (reach * sum) : 0;
        }
    }
}

// Solves matrix x = right side for every lane; x replaces it, and holds the solution from unknown `first` on.
// No pivots: the matrix, its lower triangle given and overwritten, is positive definite.
SKINGLOW_INLINE void solve_definite(std::size_t n, std::size_t first, double* matrix, double* x) {
    for (std::size_t p = 0; p < n; ++p) {
        double* pivot = matrix + triangle(p, p);
        for (std::size_t w = 0; w < lanes; ++w) pivot[w] = 1 / pivot[w];
        for (std::size_t i = p + 1; i < n; ++i) {
            double* row = matrix + triangle(i, 0);
            double factor[lanes];
            for (std::size_t w = 0; w < lanes; ++w) {
                factor[w] = row[p * lanes + w] * pivot[w];
                x[i * lanes + w] -= factor[w] * x[p * lanes + w];
            }
            for (std::size_t j = p + 1; j <= i; ++j) {
                const double* other = matrix + triangle(j, p);
                for (std::size_t w = 0; w < lanes; ++w) row[j * lanes + w] -= factor[w] * other[w];
            }
        }
    }
    for (std::size_t p = n; p-- > first;) {
        for (std::size_t i = p + 1; i < n; ++i) {
            const double* below = matrix + triangle(i, p);
            for (std::size_t w = 0; w < lanes; ++w) x[p * lanes + w] -= below[w] * x[i * lanes + w];
        }
        const double* pivot = matrix + triangle(p, p);
        for (std::size_t w = 0; w < lanes; ++w) x[p * lanes + w] *= pivot[w];
    }
}

SKINGLOW_INLINE void set_lanes(double* to, double value) {
    for (std::size_t w = 0; w < lanes; ++w) to[w] = value;
}

}  // namespace skinglow::slab
