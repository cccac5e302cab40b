#include "slab/thickness_kernel.h"

#include <algorithm>
#include <array>

#include "slab/lane_arithmetic.h"

// The same loops, compiled for processors with 256 bit registers as well and chosen when the program starts.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__)
#define SKINGLOW_FOR_EACH_PROCESSOR \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define SKINGLOW_FOR_EACH_PROCESSOR
#endif
namespace skinglow::slab {

// Equal loads. The symmetric and the antisymmetric part of the light part ways, and their difference at the
// far face,
//   T = receiver . (load + D_coth)^-1 H (load + D_tanh)^-1 source,
// is a product: nothing cancels for thin layers, nor for thick ones.
SKINGLOW_FOR_EACH_PROCESSOR
static void solve_equal(std::size_t n, const double* load, const double* source, const double* receiver,
                        Factors factors, double* transmittance, double* scratch) {
    double* from_source = scratch;
    double* from_receiver = from_source + n * lanes;
    double* matrix = from_receiver + n * lanes;
    for (std::size_t part = 0; part < 2; ++part) {
        const double* added = part == 0 ? factors.symmetric : factors.antisymmetric;
        const double* right_side = part == 0 ? source : receiver;
        double* x = part == 0 ? from_source : from_receiver;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j <= i; ++j)
                set_lanes(matrix + triangle(i, j), load[i * (i + 1) / 2 + j]);
            for (std::size_t w = 0; w < lanes; ++w) matrix[triangle(i, i) + w] += added[i * lanes + w];
            set_lanes(x + i * lanes, right_side[i]);
        }
        solve_definite(n, 0, matrix, x);
    }
    set_lanes(transmittance, 0);
    for (std::size_t i = 0; i < n * lanes; ++i) {
        transmittance[i % lanes] += from_receiver[i] * factors.through[i] * from_source[i];
    }
}

// Unequal loads, from face to face: T stays a product however small it is. Cancels like rounding / optical
// thickness.
SKINGLOW_FOR_EACH_PROCESSOR
static void solve_thick(std::size_t n, const double* above, const double* below, const double* source,
                        const double* receiver, Factors factors, double* transmittance, double* scratch) {
    double* x = scratch;
    double* matrix = x + 2 * n * lanes;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            set_lanes(matrix + triangle(i, j), above[i * (i + 1) / 2 + j]);
            set_lanes(matrix + triangle(n + i, n + j), below[i * (i + 1) / 2 + j]);
        }
        for (std::size_t j = 0; j < n; ++j) set_lanes(matrix + triangle(n + i, j), 0);
        for (std::size_t w = 0; w < lanes; ++w) {
            const double own =
                0.5 * (factors.symmetric[i * lanes + w] + factors.antisymmetric[i * lanes + w]);
            matrix[triangle(i, i) + w] += own;
            matrix[triangle(n + i, n + i) + w] += own;
            matrix[triangle(n + i, i) + w] = -factors.through[i * lanes + w];
        }
        set_lanes(x + i * lanes, source[i]);
        set_lanes(x + (n + i) * lanes, 0);
    }
    solve_definite(2 * n, n, matrix, x);
    set_lanes(transmittance, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t w = 0; w < lanes; ++w) transmittance[w] += receiver[i] * x[(n + i) * lanes + w];
    }
}

// Unequal loads, by the symmetric and the antisymmetric part, which the difference of the loads couples.
// Exact for thin layers; T is a difference and cancels for thick ones.
SKINGLOW_FOR_EACH_PROCESSOR
static void solve_thin(std::size_t n, const double* above, const double* below, const double* source,
                       const double* receiver, Factors factors, double* transmittance, double* scratch) {
    double* x = scratch;
    double* matrix = x + 2 * n * lanes;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t entry = i < j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j;
            const double mean = 0.5 * (above[entry] + below[entry]);
            if (j <= i) {
                set_lanes(matrix + triangle(i, j), mean);
                set_lanes(matrix + triangle(n + i, n + j), mean);
            }
            set_lanes(matrix + triangle(n + i, j), 0.5 * (above[entry] - below[entry]));
        }
        for (std::size_t w = 0; w < lanes; ++w) {
            matrix[triangle(i, i) + w] += factors.symmetric[i * lanes + w];
            matrix[triangle(n + i, n + i) + w] += factors.antisymmetric[i * lanes + w];
        }
        set_lanes(x + i * lanes, 0.5 * source[i]);
        set_lanes(x + (n + i) * lanes, 0.5 * source[i]);
    }
    solve_definite(2 * n, 0, matrix, x);
    set_lanes(transmittance, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t w = 0; w < lanes; ++w) {
            transmittance[w] += receiver[i] * (x[i * lanes + w] - x[(n + i) * lanes + w]);
        }
    }
}

SKINGLOW_FOR_EACH_PROCESSOR
static void all_factors(std::size_t n, const double* decay, double attenuation, const double* thickness,
                        Factors factors) {
    fill_factors(n, decay, attenuation, thickness, factors);
}

void solve_lanes(const ModeProblem& problem, double attenuation, const double* thickness,
                 double* transmittance, std::vector<double>& scratch) {
    const std::size_t n = problem.decay.size();
    const bool equal = problem.load_below.empty();
    const std::size_t unknowns = equal ? n : 2 * n;
    const std::size_t needed = lanes * (5 * n + unknowns * (unknowns + 1) / 2);
    if (scratch.size() < needed) scratch.resize(needed);
    const Factors factors{scratch.data(), scratch.data() + n * lanes, scratch.data() + 2 * n * lanes};
    double* rest = scratch.data() + 3 * n * lanes;
    all_factors(n, problem.decay.data(), attenuation, thickness, factors);
    if (equal) {
        solve_equal(n, problem.load_above.data(), problem.source.data(), problem.receiver.data(), factors,
                    transmittance, rest);
        return;
    }
    constexpr double thin = 0.1;  // optical thickness at which both ways are good to 1e-14
    const auto is_thin = [&](double d) { return attenuation * d < thin; };
    const bool any_thin = std::any_of(thickness, thickness + lanes, is_thin);
    const bool all_thin = std::all_of(thickness, thickness + lanes, is_thin);
    std::array<double, lanes> of_thin{};
    if (any_thin) {
        solve_thin(n, problem.load_above.data(), problem.load_below.data(), problem.source.data(),
                   problem.receiver.data(), factors, of_thin.data(), rest);
    }
    if (!all_thin) {
        solve_thick(n, problem.load_above.data(), problem.load_below.data(), problem.source.data(),
                    problem.receiver.data(), factors, transmittance, rest);
    }
    for (std::size_t w = 0; w < lanes; ++w) {
        if (is_thin(thickness[w])) transmittance[w] = of_thin[w];
    }
}

}  // namespace skinglow::slab
