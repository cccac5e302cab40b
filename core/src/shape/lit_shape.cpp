#include <skinglow/shape.h>

#include <algorithm>
#include <glm/common.hpp>
#include <string>

#include "numerics/argument_check.h"
#include "rig/rig_data.h"
#include "shape/lit_shape_data.h"

namespace skinglow {
namespace {

constexpr int max_reentries = 8;
constexpr int max_samples = 4096;

ShapeData::Colors recolored(const LitShapeData& lit, std::span<const glm::dvec3> colors,
                            const ShapeProgress& progress) {
    const std::size_t lights = lit.solved->rig.size();
    if (colors.size() != lights) {
        refuse_argument("colors", std::to_string(colors.size()) + " of them",
                        "one for each of " + std::to_string(lights) + " lights");
    }
    for (std::size_t k = 0; k < colors.size(); ++k) require_not_negative(entry_name("colors", k), colors[k]);
    // What is at hand is faster than starting a job.
    if (lit.matrices.ready() == nullptr) run_or_cancel(progress, [&] { lit.by_light(); });
    return lit.sum(colors);
}

}  // namespace

LitShape Shape::light(const PreparedRig& rig, const ShapeLightOptions& options,
                      const ShapeProgress& progress) const {
    if (options.reentries < 0 || options.reentries > max_reentries)
        refuse_argument("reentries", std::to_string(options.reentries), "0 to 8");
    if (options.shadow_samples < 1 || options.shadow_samples > max_samples)
        refuse_argument("shadow_samples", std::to_string(options.shadow_samples), "1 to 4096");
    LitShape result;
    run_or_cancel(progress, [&] {
        const auto solved = std::make_shared<const SolvedLight>(data_, rig, options);
        result.data_ = std::make_shared<const LitShapeData>(solved, data_);
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
        const LightMatrices& all = data_->by_light();
        const auto& site_of = data_->shape->solver->sites().site_of();
        for (std::size_t k = 0; k < lights(); ++k) {
            const std::vector<glm::mat3>& matrices = all.lights[k].exitance;
            if (matrices.empty()) continue;
            const glm::vec3 color = data_->solved->rig.data().prepared[k].color;
            for (std::size_t i = 0; i < points; ++i)
                result[k * points + i] = glm::max(matrices[site_of[i]] * color, glm::vec3(0.0F));
        }
    });
    return result;
}

std::vector<glm::dvec3> LitShape::recolor(std::span<const glm::dvec3> colors,
                                          const ShapeProgress& progress) const {
    return data_->shape->at_points(recolored(*data_, colors, progress).exitance);
}

std::vector<glm::dvec3> LitShape::recolor_transmitted(std::span<const glm::dvec3> colors,
                                                      const ShapeProgress& progress) const {
    ShapeData::Colors found = recolored(*data_, colors, progress);
    keep_transmitted(found);
    return data_->shape->at_points(found.reflected);
}

LitShape LitShape::with_tissue(const Tissue& tissue) const {
    if (!data_->shape->spectrum)
        refuse_argument("tissue", "given", "none: this shape is of coefficients, not of a tissue");
    LitShape result;
    result.data_ = std::make_shared<const LitShapeData>(
        data_->solved, std::make_shared<const ShapeData>(*data_->solved->shape, tissue));
    return result;
}

}  // namespace skinglow
