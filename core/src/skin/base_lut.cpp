#include <skinglow/lut.h>
#include <skinglow/spectrum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

constexpr std::array<std::string_view, 3> mode_names = {"existing", "paper", "physical"};

struct ProfileTerm {
    double variance;    // mm^2
    glm::dvec3 weight;  // linear RGB, each column sums to 1
};

// d'Eon and Luebke 2007, the table of section 14.4.4.
constexpr std::array<ProfileTerm, 6> skin_profile = {{{0.0064, {0.233, 0.455, 0.649}},
                                                      {0.0484, {0.100, 0.336, 0.344}},
                                                      {0.187, {0.118, 0.198, 0.000}},
                                                      {0.567, {0.113, 0.007, 0.007}},
                                                      {1.99, {0.358, 0.004, 0.000}},
                                                      {7.41, {0.078, 0.000, 0.000}}}};

}  // namespace

std::string_view to_text(LutMode mode) {
    return mode_names.at(static_cast<std::size_t>(mode));
}

LutMode lut_mode(std::string_view name) {
    for (const LutMode mode : {LutMode::existing, LutMode::paper, LutMode::physical}) {
        if (to_text(mode) == name) return mode;
    }
    refuse_argument("mode", "\"" + std::string(name) + "\"", "existing, paper or physical");
}

LutAxis::LutAxis(std::size_t size, double max_thickness_mm)
    : size_(size), max_thickness_mm_(require_positive("max_thickness_mm", max_thickness_mm)) {
    require_between("table size", size, std::size_t{1}, max_lut_size, " entries");
}

double LutAxis::thickness_mm(std::size_t i) const {
    return size_ == 1 ? 0.0 : max_thickness_mm_ * (static_cast<double>(i) / static_cast<double>(size_ - 1));
}

std::vector<double> LutAxis::thickness_mm() const {
    std::vector<double> thickness(size_);
    for (std::size_t i = 0; i < size_; ++i) thickness[i] = thickness_mm(i);
    return thickness;
}

double LutAxis::texel_scale() const {
    return static_cast<double>(size_ - 1) / static_cast<double>(size_) / max_thickness_mm_;
}

double LutAxis::texel_offset() const {
    return 0.5 / static_cast<double>(size_);
}

BaseLut BaseLut::from_gray(std::span<const double> gray, double max_thickness_mm) {
    std::vector<glm::dmat3> matrices;
    matrices.reserve(gray.size());
    for (const double brightness : gray) {
        const std::size_t i = matrices.size();
        require_not_negative([i] { return "base lookup entry " + std::to_string(i); }, brightness);
        matrices.emplace_back(brightness);  // GLM: a scalar is that multiple of the identity
    }
    return {std::move(matrices), max_thickness_mm};
}

BaseLut::BaseLut(std::vector<glm::dmat3> matrices, double max_thickness_mm)
    : axis_(matrices.size(), max_thickness_mm), matrices_(std::move(matrices)) {
    for (std::size_t i = 0; i < matrices_.size(); ++i) {
        for (int column = 0; column < 3; ++column) {
            const auto name = [i, column] {
                return "column " + std::to_string(column) + " of base lookup matrix " + std::to_string(i);
            };
            require_finite(name, matrices_[i][column]);
        }
    }
}

std::vector<glm::dvec3> recolor(const BaseLut& base, const glm::dvec3& weight) {
    std::vector<glm::dvec3> colors(base.size());
    recolor(base, weight, colors);
    return colors;
}

void recolor(const BaseLut& base, const glm::dvec3& weight, std::span<glm::dvec3> out) {
    require_finite("weight", weight);
    require_count("output", out.size(), base.size(), "the base's");
    const std::span<const glm::dmat3> matrices = base.matrices();
    // 0 * value is 0 for every finite value and NaN for the others: one sum checks the table without a branch
    // a texel.
    glm::dvec3 overflow(0.0);
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        out[i] = matrices[i] * weight;
        overflow += 0.0 * out[i];
    }
    if (overflow != glm::dvec3(0.0)) {
        refuse_argument("weight", to_text(weight), "one whose product with the base lookup stays finite");
    }
}

std::vector<glm::dvec3> table_at(std::span<const glm::dvec3> colors, double texel_scale, double texel_offset,
                                 std::span<const double> thickness_mm) {
    require("number of colors", colors.size(), !colors.empty(), "1 or more");
    for (std::size_t i = 0; i < colors.size(); ++i) require_finite(entry_name("colors", i), colors[i]);
    require_finite("texel scale", texel_scale);
    require_finite("texel offset", texel_offset);
    std::vector<glm::dvec3> result(thickness_mm.size());
    const auto size = static_cast<double>(colors.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double thickness = require_finite(entry_name("thickness_mm", i), thickness_mm[i]);
        const double at = std::clamp((texel_scale * thickness + texel_offset) * size - 0.5, 0.0, size - 1);
        const auto below = static_cast<std::size_t>(at);
        const std::size_t above = std::min(below + 1, colors.size() - 1);
        result[i] = glm::mix(colors[below], colors[above], at - static_cast<double>(below));
    }
    return result;
}

std::vector<glm::dvec3> six_gaussian_lookup(const LutAxis& axis) {
    std::vector<glm::dvec3> colors(axis.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < axis.size(); ++i) {
        const double thickness = axis.thickness_mm(i);
        for (const ProfileTerm& term : skin_profile) {
            // Divided before multiplied: the square of a thickness of 1e200 mm would overflow.
            colors[i] += term.weight * std::exp(-thickness * (thickness / term.variance));
        }
    }
    return colors;
}

BaseLut six_gaussian_base(const LutAxis& axis) {
    std::vector<double> brightness;
    brightness.reserve(axis.size());
    for (const glm::dvec3& color : six_gaussian_lookup(axis)) brightness.push_back(luminance(color));
    return BaseLut::from_gray(brightness, axis.max_thickness_mm());
}

}  // namespace skinglow
