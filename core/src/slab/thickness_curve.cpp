#include "slab/thickness_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "slab/slab_arguments.h"
#include "slab/variable_layer.h"

namespace skinglow {

class ThicknessCurve::Solution : public slab::VariableLayer {
    using VariableLayer::VariableLayer;
};

namespace {

std::vector<Layer> checked(std::span<const Layer> layers, std::size_t variable_layer, Incidence incidence,
                           double n_above, double n_below, int streams) {
    std::vector<Layer> copy(layers.begin(), layers.end());
    if (!copy.empty() && variable_layer >= copy.size()) {
        refuse_argument("variable_layer", std::to_string(variable_layer),
                        "0 to " + std::to_string(copy.size() - 1));
    }
    if (!copy.empty()) copy[variable_layer].thickness = 0;
    slab::check_arguments(copy, incidence, n_above, n_below, streams);
    if (std::isinf(copy.back().thickness)) {
        refuse_argument("layers[" + std::to_string(copy.size() - 1) + "].thickness", "inf",
                        "a finite number of mm: nothing comes through a half-space");
    }
    return copy;
}

}  // namespace

ThicknessCurve::ThicknessCurve(std::span<const Layer> layers, std::size_t variable_layer, Incidence incidence,
                               double n_above, double n_below, int streams)
    : solution_(std::make_shared<const Solution>(
          checked(layers, variable_layer, incidence, n_above, n_below, streams), variable_layer, incidence,
          n_above, n_below, streams)) {}
ThicknessCurve::~ThicknessCurve() = default;
ThicknessCurve::ThicknessCurve(const ThicknessCurve&) = default;
ThicknessCurve::ThicknessCurve(ThicknessCurve&&) noexcept = default;
ThicknessCurve& ThicknessCurve::operator=(const ThicknessCurve&) = default;
ThicknessCurve& ThicknessCurve::operator=(ThicknessCurve&&) noexcept = default;

double ThicknessCurve::transmittance(double inner_thickness_mm) const {
    double out = 0;
    transmittance(std::span<const double>(&inner_thickness_mm, 1), std::span<double>(&out, 1));
    return out;
}

void ThicknessCurve::transmittance(std::span<const double> inner_thickness_mm, std::span<double> out) const {
    if (out.size() != inner_thickness_mm.size()) {
        refuse_argument("out", std::to_string(out.size()) + " entries", "as many as there are thicknesses");
    }
    for (const double d : inner_thickness_mm) require_not_negative("thickness_mm", d);
    std::vector<double> scratch;
    for (std::size_t first = 0; first < out.size(); first += slab::lanes) {
        const std::size_t count = std::min(slab::lanes, out.size() - first);
        std::array<double, slab::lanes> thickness{};
        std::array<double, slab::lanes> solved{};
        // Lanes that would be empty repeat the last thickness.
        for (std::size_t i = 0; i < slab::lanes; ++i) {
            thickness[i] = inner_thickness_mm[first + std::min(i, count - 1)];
        }
        const double thinnest = *std::min_element(thickness.begin(), thickness.end());
        slab::solve_lanes(solution_->problem_for(thinnest), solution_->attenuation, thickness.data(),
                          solved.data(), scratch);
        for (std::size_t i = 0; i < count; ++i) out[first + i] = std::clamp(solved[i], 0.0, 1.0);
    }
}

double ThicknessCurve::decay_rate() const {
    return solution_->decay.back();
}

}  // namespace skinglow
