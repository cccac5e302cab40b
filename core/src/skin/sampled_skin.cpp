#include "skin/sampled_skin.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "numerics/worst.h"
#include "skin/skin_transmittance.h"

namespace skinglow {
namespace {

constexpr double darkest = 1e-6;  // what the norm takes for the smallest number of a column

double largest(const glm::dvec3& column) {
    return worst(worst(std::abs(column.x), std::abs(column.y)), std::abs(column.z));
}

}  // namespace

std::vector<glm::dmat3> matrices(const ThicknessRows& log_transmittance, std::size_t count) {
    std::vector<glm::dmat3> result(count, glm::dmat3(0.0));
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        const glm::dmat3 weight = matrix_weights()[k];
        for (std::size_t i = 0; i < count; ++i) result[i] += weight * std::exp(log_transmittance[k][i]);
    }
    return result;
}

double matrix_error(const glm::dmat3& matrix, const glm::dmat3& exact) {
    double error = 0.0;
    for (int j = 0; j < 3; ++j) {
        error = worst(error, largest(matrix[j] - exact[j]) / std::max(largest(exact[j]), darkest));
    }
    return error;
}

double largest_error(const std::vector<glm::dmat3>& found, const std::vector<glm::dmat3>& exact) {
    double error = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) error = worst(error, matrix_error(found[i], exact[i]));
    return error;
}

SampledSkin::SampledSkin(const Tissue& tissue, const ThicknessNodes& nodes, double share, int streams)
    : tissue_(tissue), nodes_(nodes), streams_(streams), count_(nodes.thickness_mm().size()) {
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        curves_.emplace_back(tissue, sample_wavelength_nm(k), DiffusionCurve::Coefficient::asymptotic);
        diffusion_[k].reserve(count_);
        for (const double thickness : nodes.thickness_mm()) {
            diffusion_[k].push_back(curves_[k].log_transmittance(thickness));
        }
    }
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        const Layer inner = skin_media(tissue, sample_wavelength_nm(k)).inner;
        absorption_[k] =
            std::sqrt(inner.absorption / (inner.absorption + inner.scattering * (1.0 - inner.anisotropy)));
    }
    find_reach(share);
}

double SampledSkin::solve(std::size_t step, double allowed) {
    std::vector<Gap> gaps;
    for (std::size_t k = 0; k + 2 * step < spectral_samples; k += 2 * step)
        gaps.push_back(solved_gap(k, k + 2 * step, 0.0));
    for (;;) {
        double left = 0.0;
        for (const Gap& gap : gaps) left += gap.surprise;
        if (left <= allowed) return left;
        const auto worst = std::max_element(
            gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.surprise < b.surprise; });
        const std::size_t middle = (worst->first + worst->last) / 2;
        const Gap upper = solved_gap(middle, worst->last, worst->surprise);
        *worst = solved_gap(worst->first, middle, worst->surprise);
        gaps.push_back(upper);
    }
}

SampledSkin::Gap SampledSkin::solved_gap(std::size_t first, std::size_t last, double whole) {
    const std::size_t middle = (first + last) / 2;
    for (const std::size_t k : {first, middle, last}) solve_sample(k);
    const std::size_t half = middle - first;
    if (half < 2) return {first, last, 0.0};  // nothing is left unsolved
    // Half a gap has an eighth of the whole one's surprise; where it shows less, that is chance.
    double surprise = whole / 8.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const auto at = [&](std::size_t k) { return i < correction_[k].size() ? correction_[k][i] : 0.0; };
        const double t = place_between(middle, first, last);
        const double off = std::abs(at(middle) - (1.0 - t) * at(first) - t * at(last));
        const auto slope = [&](std::size_t a, std::size_t b) {
            constexpr double flat = 1e-9;  // keeps the quotient finite where absorption stays as it is
            return std::abs(at(b) - at(a)) / std::max(flat, std::abs(absorption_[b] - absorption_[a]));
        };
        const double with_blood = std::max(slope(first, middle), slope(middle, last));
        glm::dvec3 change(0.0);
        for (std::size_t k = first + 1; k < last; ++k) {
            if (i >= reach_[k] || k == middle) continue;
            // Off by half of what the middle was, or by as much as blood's spectrum bends between the solved
            // ones, and all unsolved samples to the same side.
            const std::size_t from = k < middle ? first : middle;
            const double straight = static_cast<double>(k - from) / static_cast<double>(half);
            const double bend = std::abs(absorption_[k] - (1.0 - straight) * absorption_[from] -
                                         straight * absorption_[from + half]);
            const double part =
                std::min(0.5, std::max(0.5 * off, with_blood * bend)) * std::exp(diffusion_[k][i]);
            for (int j = 0; j < 3; ++j) change[j] += part * largest(matrix_weights()[k][j]);
        }
        for (int j = 0; j < 3; ++j) surprise = worst(surprise, change[j] / scale_[i][j]);
    }
    return {first, last, surprise};
}

double SampledSkin::place_between(std::size_t k, std::size_t first, std::size_t last) const {
    const auto from = absorption_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto to = absorption_.begin() + static_cast<std::ptrdiff_t>(last) + 1;
    const bool runs_one_way = std::is_sorted(from, to) || std::is_sorted(from, to, std::greater<>{});
    const double difference = absorption_[last] - absorption_[first];
    if (runs_one_way && difference != 0.0) return (absorption_[k] - absorption_[first]) / difference;
    return static_cast<double>(k - first) / static_cast<double>(last - first);
}

void SampledSkin::solve_sample(std::size_t k) {
    if (!correction_[k].empty()) return;
    // As far as it matters itself or to those that may be filled in from it.
    constexpr std::size_t neighbors = 15;
    const auto from = reach_.begin() + static_cast<std::ptrdiff_t>(k > neighbors ? k - neighbors : 0);
    const auto to =
        reach_.begin() + static_cast<std::ptrdiff_t>(std::min(k + neighbors + 1, spectral_samples));
    const std::size_t reach = *std::max_element(from, to);
    correction_[k] = solved_log_transmittance(k, reach, streams_);
    for (std::size_t i = 0; i < reach; ++i) correction_[k][i] -= diffusion_[k][i];
}

ThicknessRows SampledSkin::correction() const {
    ThicknessRows filled;
    const std::vector<std::size_t> known = solved();
    for (std::size_t s = 0; s + 1 < known.size(); ++s) {
        const ThicknessRow &first = correction_[known[s]], &last = correction_[known[s + 1]];
        for (std::size_t k = known[s]; k <= known[s + 1]; ++k) {
            const double t = place_between(k, known[s], known[s + 1]);
            filled[k].resize(count_);
            for (std::size_t i = 0; i < reach_[k]; ++i) filled[k][i] = (1.0 - t) * first[i] + t * last[i];
            // Beyond its reach a wavelength does not matter; its correction has come to rest in any case.
            for (std::size_t i = reach_[k]; i < count_; ++i) filled[k][i] = i > 0 ? filled[k][i - 1] : 0.0;
        }
    }
    return filled;
}

ThicknessRows SampledSkin::log_transmittance(const ThicknessRows& correction) const {
    ThicknessRows sum = diffusion_;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        for (std::size_t i = 0; i < count_; ++i) sum[k][i] += correction[k][i];
    }
    return sum;
}

ThicknessRows SampledSkin::log_transmittance_at_entries(const ThicknessRows& correction) const {
    const std::span<const double> entries = nodes_.entries_mm();
    ThicknessRows result;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        ThicknessRow& row = result[k];
        row.resize(entries.size());
        nodes_.to_entries(correction[k], row);
        double last = 0.0;
        for (std::size_t i = 0; i < row.size(); ++i) {
            // Light never grows with thickness, whatever the correction's curve does between its nodes.
            // In this order a NaN is handed on, and BaseLut refuses it; the other way round it would be
            // hidden.
            last = row[i] = std::min(row[i] + curves_[k].log_transmittance(entries[i]), last);
        }
    }
    return result;
}

double SampledSkin::stream_difference(int streams) const {
    const std::vector<std::size_t> known = solved();
    double difference = 0.0;
    const std::size_t step = std::max<std::size_t>(1, known.size() / 3);
    for (std::size_t s = step / 2; s < known.size(); s += step) {
        const std::size_t k = known[s];
        const ThicknessRow better = solved_log_transmittance(k, correction_[k].size(), streams);
        for (std::size_t i = 0; i < better.size(); ++i) {
            difference =
                worst(difference, std::abs(std::expm1(diffusion_[k][i] + correction_[k][i] - better[i])));
        }
    }
    return difference;
}

std::vector<std::size_t> SampledSkin::solved() const {
    std::vector<std::size_t> known;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        if (!correction_[k].empty()) known.push_back(k);
    }
    return known;
}

std::vector<double> SampledSkin::solved_nm() const {
    std::vector<double> nm;
    for (const std::size_t k : solved()) nm.push_back(sample_wavelength_nm(k));
    return nm;
}

std::size_t SampledSkin::pairs_solved() const {
    std::size_t pairs = 0;
    for (const ThicknessRow& row : correction_) pairs += row.size();
    return pairs;
}

std::size_t SampledSkin::pairs_skipped() const {
    std::size_t pairs = 0;
    for (const std::size_t reach : reach_) pairs += count_ - reach;
    return pairs;
}

ThicknessRow SampledSkin::solved_log_transmittance(std::size_t k, std::size_t reach, int streams) const {
    ThicknessRow row(reach);
    SkinCurve(tissue_, sample_wavelength_nm(k), Incidence::diffuse(), streams)
        .transmittance(nodes_.thickness_mm().first(reach), row);
    constexpr double least = 1e-300;  // a logarithm of 0 would be infinite; no picture shows either
    for (double& value : row) value = std::log(std::max(value, least));
    return row;
}

void SampledSkin::find_reach(double share) {
    for (const glm::dmat3& estimate : matrices(diffusion_, count_)) {
        glm::dvec3 scale;
        for (int j = 0; j < 3; ++j) scale[j] = std::max(largest(estimate[j]), darkest);
        scale_.push_back(scale);
    }
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        for (std::size_t i = 0; i < count_; ++i) {
            const double t = std::exp(diffusion_[k][i]);
            for (int j = 0; j < 3; ++j) {
                if (t * largest(matrix_weights()[k][j]) > share * scale_[i][j]) reach_[k] = i + 1;
            }
        }
    }
    // No wavelength is left out of the thinnest skin, so that every one has a correction to go on with.
    for (std::size_t& reach : reach_) reach = std::max<std::size_t>(reach, 1);
}

}  // namespace skinglow
