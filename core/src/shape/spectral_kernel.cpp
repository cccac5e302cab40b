#include <algorithm>
#include <cstddef>
#include <span>

#include "shape/spectral_samples.h"

// Compiled once for each kind of processor that Highway knows; the best one is chosen at run time. A vector
// holds one number of several wavelengths, one to a lane.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shape/spectral_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, SpectralSamples::alignment>;
using Vector = hn::Vec<Tag>;

void sum_runs(const SpectralSamples& samples, std::span<const float> at_nodes, float limit, double* sums) {
    const Tag tag;
    const std::size_t step = hn::Lanes(tag);
    constexpr std::size_t entries = 9;
    const auto row = [&](std::size_t r) { return samples.rows.data() + r * samples.size; };
    Vector sum[entries];
    for (Vector& entry : sum) entry = hn::Zero(tag);
    for (const SpectralSamples::Run& run : samples.runs) {
        const float first = at_nodes[run.segment];
        const float second = at_nodes[run.segment + 1];
        // A polynomial may oscillate between nodes that differ by orders of magnitude: it stays between its
        // neighbors, and beyond the last node below that. exp is 0 below -87, not far above the least number
        // there is.
        const bool between = run.side == NodeSide::between;
        const float largest = run.side == NodeSide::before ? limit
                              : between                    ? std::max(first, second)
                                                           : second;
        const Vector low = hn::Set(tag, std::max(-86.0F, between ? std::min(first, second) : -86.0F));
        const Vector high = hn::Set(tag, std::max(-86.0F, largest));
        for (std::size_t i = run.begin; i < run.end; i += step) {
            Vector logarithm = hn::Zero(tag);
            for (std::size_t k = 0; k < at_nodes.size(); ++k)
                logarithm = hn::MulAdd(hn::Set(tag, at_nodes[k]), hn::LoadU(tag, row(k) + i), logarithm);
            const Vector value = hn::Exp(tag, hn::Min(hn::Max(logarithm, low), high));
            for (std::size_t e = 0; e < entries; ++e)
                sum[e] = hn::MulAdd(value, hn::LoadU(tag, row(at_nodes.size() + e) + i), sum[e]);
        }
    }
    for (std::size_t e = 0; e < entries; ++e)
        sums[e] = static_cast<double>(hn::GetLane(hn::SumOfLanes(tag, sum[e])));
}

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinglow::detail {

HWY_EXPORT(sum_runs);

std::array<double, 9> sum_samples(const SpectralSamples& samples, std::span<const float> at_nodes,
                                  float limit) {
    std::array<double, 9> sums{};
    HWY_DYNAMIC_DISPATCH(sum_runs)(samples, at_nodes, limit, sums.data());
    return sums;
}

}  // namespace skinglow::detail
#endif
