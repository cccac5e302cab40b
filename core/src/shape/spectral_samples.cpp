#include "shape/spectral_samples.h"

#include <algorithm>
#include <map>

namespace skinglow::detail {

SpectralSample NodeInterpolation::at(double x) const {
    SpectralSample sample;
    const auto above = std::upper_bound(at_.begin() + 1, at_.end() - 1, x);
    sample.segment = static_cast<std::size_t>(above - at_.begin()) - 1;
    if (x < at_.front()) sample.side = NodeSide::before;
    if (x > at_.back()) sample.side = NodeSide::beyond;
    if (sample.side != NodeSide::between) {
        const double left = at_[sample.segment];
        const double t = (x - left) / (at_[sample.segment + 1] - left);
        sample.weight[sample.segment] = 1.0 - t;
        sample.weight[sample.segment + 1] = t;
        return sample;
    }
    for (std::size_t i = 0; i < at_.size(); ++i) {
        double weight = 1.0;
        for (std::size_t j = 0; j < at_.size(); ++j) {
            if (j != i) weight *= (x - at_[j]) / (at_[i] - at_[j]);
        }
        sample.weight[i] = weight;
    }
    return sample;
}

double value_of(const SpectralSample& sample, std::span<const double> at_nodes) {
    double value = 0.0;
    for (std::size_t i = 0; i < at_nodes.size(); ++i) value += sample.weight[i] * at_nodes[i];
    if (sample.side != NodeSide::between) return value;
    const auto [low, high] = std::minmax(at_nodes[sample.segment], at_nodes[sample.segment + 1]);
    return std::clamp(value, low, high);
}

SpectralSamples in_runs(std::span<const SpectralSample> samples, std::size_t nodes) {
    const auto kind = [](const SpectralSample& sample) { return std::pair(sample.segment, sample.side); };
    std::map<std::pair<std::size_t, NodeSide>, std::vector<SpectralSample>> runs;
    for (const SpectralSample& sample : samples) runs[kind(sample)].push_back(sample);
    SpectralSamples result;
    for (const auto& [stands, members] : runs) {
        const std::size_t end = result.size + members.size();
        result.runs.push_back({result.size, end, stands.first, stands.second});
        result.size =
            (end + SpectralSamples::alignment - 1) / SpectralSamples::alignment * SpectralSamples::alignment;
    }
    result.rows.assign((nodes + 9) * result.size, 0.0F);
    for (const SpectralSamples::Run& run : result.runs) {
        const std::vector<SpectralSample>& members = runs.at({run.segment, run.side});
        for (std::size_t i = 0; i < members.size(); ++i) {
            float* const column = result.rows.data() + run.begin + i;
            for (std::size_t k = 0; k < nodes; ++k)
                column[k * result.size] = static_cast<float>(members[i].weight[k]);
            for (int entry = 0; entry < 9; ++entry) {
                column[(nodes + static_cast<std::size_t>(entry)) * result.size] =
                    static_cast<float>(members[i].matrix[entry / 3][entry % 3]);
            }
        }
    }
    return result;
}

}  // namespace skinglow::detail
