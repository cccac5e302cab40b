#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "slab/stream_grid.h"
#include "slab/variable_layer.h"

// Compiled once for each kind of processor that Highway knows; the best one is chosen at run time. A vector
// holds one unknown of several thicknesses, one to a lane.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "slab/thickness_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Tag>;

// Arrays of vectors in memory.
HWY_INLINE Vector load(const double* array, std::size_t i) {
    return hn::Load(Tag(), array + i * hn::Lanes(Tag()));
}
HWY_INLINE void store(Vector value, double* array, std::size_t i) {
    hn::Store(value, Tag(), array + i * hn::Lanes(Tag()));
}
HWY_INLINE Vector set(double value) {
    return hn::Set(Tag(), value);
}

// Index of entry (i, j) in the lower triangle of a matrix.
HWY_INLINE std::size_t triangle(std::size_t i, std::size_t j) {
    return i * (i + 1) / 2 + j;
}

// k tanh(k d / 2), k coth(k d / 2) and k / sinh(k d) of every mode.
struct Factors {
    double* symmetric;
    double* antisymmetric;
    double* through;
};

HWY_INLINE void fill_factors(const ModeProblem& problem, double attenuation, Vector thickness,
                             const Factors& factors) {
    const Tag tag;
    const Vector deepest = set(700);  // exp(-700) is near the smallest number there is
    // Light beyond the critical angle meets no load at either face: only the layer's own k tanh(k d / 2)
    // keeps its pivots above rounding. So a layer is never thinner than 1e-11 of its fastest mode's length,
    // which changes T by as much. Where the fast modes are left out, the slowest alone, without absorption
    // near 0, must not set that length: the attenuation does.
    double fastest = attenuation;
    for (const double k : problem.decay) fastest = std::max(k, fastest);
    const Vector d = hn::Max(thickness, set(fastest > 1e-250 ? 1e-11 / fastest : 1e-200));
    for (std::size_t i = 0; i < problem.decay.size(); ++i) {
        const Vector k = set(problem.decay[i]);
        const Vector depth = hn::Min(hn::Mul(k, d), deepest);
        const Vector passed = hn::Exp(tag, hn::Neg(depth));
        const Vector lost = hn::Neg(hn::Expm1(tag, hn::Neg(depth)));
        const Vector lost_per_k = hn::IfThenElse(hn::Gt(depth, set(1e-290)), hn::Div(lost, k), d);
        const Vector sum = hn::Add(passed, set(1));
        store(hn::Div(hn::Mul(k, lost), sum), factors.symmetric, i);
        store(hn::Div(sum, lost_per_k), factors.antisymmetric, i);
        const Vector through = hn::Div(hn::Add(passed, passed), hn::Mul(lost_per_k, sum));
        store(hn::IfThenElseZero(hn::Lt(depth, deepest), through), factors.through, i);
    }
}

// Solves matrix x = right side; x replaces it, and holds the solution from unknown `first` on. No pivoting:
// the matrix, its lower triangle given and overwritten, is positive definite.
HWY_INLINE void solve_definite(std::size_t n, std::size_t first, double* matrix, double* x) {
    for (std::size_t p = 0; p < n; ++p) {
        const Vector pivot = hn::Div(set(1), load(matrix, triangle(p, p)));
        store(pivot, matrix, triangle(p, p));
        const Vector known = load(x, p);
        for (std::size_t i = p + 1; i < n; ++i) {
            const std::size_t row = triangle(i, 0);
            const Vector factor = hn::Mul(load(matrix, row + p), pivot);
            store(hn::NegMulAdd(factor, known, load(x, i)), x, i);
            for (std::size_t j = p + 1; j <= i; ++j) {
                const Vector other = load(matrix, triangle(j, p));
                store(hn::NegMulAdd(factor, other, load(matrix, row + j)), matrix, row + j);
            }
        }
    }
    for (std::size_t p = n; p-- > first;) {
        Vector sum = load(x, p);
        for (std::size_t i = p + 1; i < n; ++i) {
            sum = hn::NegMulAdd(load(matrix, triangle(i, p)), load(x, i), sum);
        }
        store(hn::Mul(sum, load(matrix, triangle(p, p))), x, p);
    }
}

// Equal loads. The symmetric and the antisymmetric part of the light are independent, and their difference at
// the far face,
//   T = receiver . (load + D_coth)^-1 H (load + D_tanh)^-1 source,
// is a product: nothing cancels for thin layers, nor for thick ones.
HWY_INLINE Vector solve_equal(const ModeProblem& problem, const Factors& factors, double* scratch) {
    const std::size_t n = problem.decay.size();
    double* from_source = scratch;
    double* from_receiver = from_source + n * hn::Lanes(Tag());
    double* matrix = from_receiver + n * hn::Lanes(Tag());
    for (const bool symmetric : {true, false}) {
        const double* added = symmetric ? factors.symmetric : factors.antisymmetric;
        const double* right_side = symmetric ? problem.source.data() : problem.receiver.data();
        double* x = symmetric ? from_source : from_receiver;
        for (std::size_t i = 0; i < n; ++i) {
            const double* row = problem.load_above.data() + triangle(i, 0);
            for (std::size_t j = 0; j < i; ++j) store(set(row[j]), matrix, triangle(i, j));
            store(hn::Add(set(row[i]), load(added, i)), matrix, triangle(i, i));
            store(set(right_side[i]), x, i);
        }
        solve_definite(n, 0, matrix, x);
    }
    Vector transmittance = hn::Zero(Tag());
    for (std::size_t i = 0; i < n; ++i) {
        const Vector through = hn::Mul(load(factors.through, i), load(from_source, i));
        transmittance = hn::MulAdd(load(from_receiver, i), through, transmittance);
    }
    return transmittance;
}

// Unequal loads, from face to face: T stays a product however small it is. Cancels like rounding / optical
// thickness.
HWY_INLINE Vector solve_thick(const ModeProblem& problem, const Factors& factors, double* scratch) {
    const std::size_t n = problem.decay.size();
    double* x = scratch;
    double* matrix = x + 2 * n * hn::Lanes(Tag());
    for (std::size_t i = 0; i < n; ++i) {
        const double* above = problem.load_above.data() + triangle(i, 0);
        const double* below = problem.load_below.data() + triangle(i, 0);
        for (std::size_t j = 0; j <= i; ++j) {
            store(set(above[j]), matrix, triangle(i, j));
            store(set(below[j]), matrix, triangle(n + i, n + j));
        }
        for (std::size_t j = 0; j < n; ++j) store(hn::Zero(Tag()), matrix, triangle(n + i, j));
        const Vector own =
            hn::Mul(set(0.5), hn::Add(load(factors.symmetric, i), load(factors.antisymmetric, i)));
        store(hn::Add(set(above[i]), own), matrix, triangle(i, i));
        store(hn::Add(set(below[i]), own), matrix, triangle(n + i, n + i));
        store(hn::Neg(load(factors.through, i)), matrix, triangle(n + i, i));
        store(set(problem.source[i]), x, i);
        store(hn::Zero(Tag()), x, n + i);
    }
    solve_definite(2 * n, n, matrix, x);
    Vector transmittance = hn::Zero(Tag());
    for (std::size_t i = 0; i < n; ++i) {
        transmittance = hn::MulAdd(set(problem.receiver[i]), load(x, n + i), transmittance);
    }
    return transmittance;
}

// Unequal loads, by the symmetric and the antisymmetric part, which the difference of the loads couples.
// Exact for thin layers; T is a difference and cancels for thick ones.
HWY_INLINE Vector solve_thin(const ModeProblem& problem, const Factors& factors, double* scratch) {
    const std::size_t n = problem.decay.size();
    double* x = scratch;
    double* matrix = x + 2 * n * hn::Lanes(Tag());
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t entry = i < j ? triangle(j, i) : triangle(i, j);
            const double above = problem.load_above[entry];
            const double below = problem.load_below[entry];
            if (j <= i) {
                store(set(0.5 * (above + below)), matrix, triangle(i, j));
                store(set(0.5 * (above + below)), matrix, triangle(n + i, n + j));
            }
            store(set(0.5 * (above - below)), matrix, triangle(n + i, j));
        }
        const std::size_t own = triangle(i, i);
        const std::size_t other = triangle(n + i, n + i);
        store(hn::Add(load(matrix, own), load(factors.symmetric, i)), matrix, own);
        store(hn::Add(load(matrix, other), load(factors.antisymmetric, i)), matrix, other);
        store(set(0.5 * problem.source[i]), x, i);
        store(set(0.5 * problem.source[i]), x, n + i);
    }
    solve_definite(2 * n, 0, matrix, x);
    Vector transmittance = hn::Zero(Tag());
    for (std::size_t i = 0; i < n; ++i) {
        const Vector difference = hn::Sub(load(x, i), load(x, n + i));
        transmittance = hn::MulAdd(set(problem.receiver[i]), difference, transmittance);
    }
    return transmittance;
}

void solve_thicknesses(const VariableLayer& layer, std::span<const double> thickness_mm,
                       std::span<double> out) {
    const std::size_t lanes = hn::Lanes(Tag());
    const std::size_t n = layer.modes();
    const auto memory = hwy::AllocateAligned<double>(lanes * (1 + 5 * n + n * (2 * n + 1)));
    double* thickness = memory.get();
    const Factors factors{thickness + lanes, thickness + (1 + n) * lanes, thickness + (1 + 2 * n) * lanes};
    double* scratch = thickness + (1 + 3 * n) * lanes;
    const Vector thin = set(0.1 / layer.attenuation());  // optical thickness at which both are good to 1e-14
    for (std::size_t first = 0; first < out.size(); first += lanes) {
        const std::size_t count = std::min(lanes, out.size() - first);
        // Lanes that would be empty repeat the last thickness.
        for (std::size_t i = 0; i < lanes; ++i) thickness[i] = thickness_mm[first + std::min(i, count - 1)];
        const ModeProblem& problem = layer.problem_for(*std::min_element(thickness, thickness + lanes));
        const Vector d = load(thickness, 0);
        fill_factors(problem, layer.attenuation(), d, factors);
        Vector solved = hn::Zero(Tag());
        if (problem.load_below.empty()) {
            solved = solve_equal(problem, factors, scratch);
        } else {
            const auto is_thin = hn::Lt(d, thin);
            if (!hn::AllTrue(Tag(), is_thin)) solved = solve_thick(problem, factors, scratch);
            if (!hn::AllFalse(Tag(), is_thin)) {
                solved = hn::IfThenElse(is_thin, solve_thin(problem, factors, scratch), solved);
            }
        }
        store(solved, thickness, 0);
        std::copy_n(thickness, count, out.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinglow::detail {

HWY_EXPORT(solve_thicknesses);

void VariableLayer::transmittance(std::span<const double> thickness_mm, std::span<double> out) const {
    HWY_DYNAMIC_DISPATCH(solve_thicknesses)(*this, thickness_mm, out);
    for (double& value : out) value = flux_fraction("transmittance", value, streams_);
}

}  // namespace skinglow::detail
#endif
