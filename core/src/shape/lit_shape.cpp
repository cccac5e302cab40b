#include <skinglow/shape.h>

#include <algorithm>
#include <glm/common.hpp>
#include <string>

#include "numerics/argument_check.h"
#include "rig/rig_data.h"
#include "shape/lit_shape_data.h"

namespace skinglow {
namespace {

constexpr int max_samples = 4096;
constexpr double min_tolerance = 1e-6;
constexpr double max_tolerance = 0.5;

/// Checks the colors, and has each light solved by itself.
void prepare_recolor(const LitShapeData& lit, std::span<const glm::dvec3> colors,
                     const ShapeProgress& progress) {
    const std::size_t lights = lit.solved->rig.size();
    if (colors.size() != lights) {
        refuse_argument("colors", std::to_string(colors.size()) + " of them",
                        "one for each of " + std::to_string(lights) + " lights");
    }
    for (std::size_t k = 0; k < colors.size(); ++k) require_not_negative(entry_name("colors", k), colors[k]);
    // What is at hand is faster than starting a job.
    if (!lit.is_each_solved()) run_or_cancel(progress, [&] { lit.solve_each(); });
}

}  // namespace

LitShape Shape::light(const PreparedRig& rig, const ShapeLightOptions& options,
                      const ShapeProgress& progress) const {
    if (options.reentries < 0 || options.reentries > detail::max_reentries)
        refuse_argument("reentries", std::to_string(options.reentries), "0 to 8");
    if (options.shadow_samples < 1 || options.shadow_samples > max_samples)
        refuse_argument("shadow_samples", std::to_string(options.shadow_samples), "1 to 4096");
    if (!(options.solver_tolerance >= min_tolerance && options.solver_tolerance <= max_tolerance))
        refuse_argument("solver_tolerance", to_text(options.solver_tolerance), "1e-6 to 0.5");
    for (std::size_t i = 0; i < options.shadowless.size(); ++i) {
        if (options.shadowless[i] >= rig.size())
            refuse_argument(entry_name("shadowless", i)(), std::to_string(options.shadowless[i]),
                            "indices of the " + std::to_string(rig.size()) + " lights");
    }
    const detail::LitShapeData* const previous =
        options.previous != nullptr ? options.previous->data_.get() : nullptr;
    LitShape result;
    run_or_cancel(progress, [&] {
        const auto solved = std::make_shared<const SolvedLight>(
            LightScene(data_, rig, options), previous != nullptr ? previous->solved.get() : nullptr);
        result.data_ = std::make_shared<const LitShapeData>(solved, data_, previous);
    });
    return result;
}

const std::vector<glm::dvec3>& LitShape::exitance() const {
    return data_->exitance;
}
const std::vector<glm::dvec3>& LitShape::transmitted() const {
    return data_->transmitted;
}
std::vector<glm::dvec3> LitShape::error() const {
    return data_->shape->at_points(data_->error());
}
LitShape::MeanError LitShape::mean_error() const {
    const detail::MeanError found = data_->mean_error();
    return {found.of_all, found.of_parts};
}
const std::vector<glm::dvec3>& LitShape::irradiance() const {
    return data_->solved->irradiance;
}
std::size_t LitShape::lights() const {
    return data_->solved->rig.size();
}
const std::vector<std::size_t>& LitShape::left_out() const {
    return data_->solved->left_out;
}

std::vector<glm::dvec3> LitShape::per_light(const ShapeProgress& progress) const {
    const std::size_t points = data_->shape->points.size();
    std::vector<glm::dvec3> result(lights() * points, glm::dvec3(0.0));
    run_or_cancel(progress, [&] {
        data_->solve_each();
        const auto& site_of = data_->shape->solver->sites().site_of();
        for (std::size_t k = 0; k < lights(); ++k) {
            const ShapeData::Matrices* of_light = data_->solved->may_shine(k) ? data_->matrices(k) : nullptr;
            if (of_light == nullptr) continue;
            const auto& light = data_->solved->rig.data().prepared[k];
            const glm::dvec3 color = data_->solved->strength(k, light.color);
            for (std::size_t i = 0; i < points; ++i) {
                const glm::dvec3 alone = glm::dmat3(of_light->exitance[site_of[i]]) * color;
                // What is out of gamut is cut; what a light takes away is not.
                result[k * points + i] =
                    light.power < 0 ? glm::min(alone, glm::dvec3(0.0)) : glm::max(alone, glm::dvec3(0.0));
            }
        }
    });
    return result;
}

std::vector<glm::dvec3> LitShape::recolor(std::span<const glm::dvec3> colors,
                                          const ShapeProgress& progress) const {
    prepare_recolor(*data_, colors, progress);
    return data_->shape->at_points(data_->sum(colors).exitance);
}

std::vector<glm::dvec3> LitShape::recolor_transmitted(std::span<const glm::dvec3> colors,
                                                      const ShapeProgress& progress) const {
    prepare_recolor(*data_, colors, progress);
    return data_->transmitted_of(colors);
}

LitShape LitShape::with_tissue(const Tissue& tissue) const {
    if (!data_->shape->spectrum)
        refuse_argument("tissue", "given", "none: this shape is of coefficients, not of a tissue");
    LitShape result;
    result.data_ = std::make_shared<const LitShapeData>(
        data_->solved, std::make_shared<const ShapeData>(*data_->solved->shape, tissue), nullptr);
    return result;
}

}  // namespace skinglow
