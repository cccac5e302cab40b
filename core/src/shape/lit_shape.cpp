#include <skinglow/shape.h>

#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "rig/rig_data.h"
#include "shape/shape_data.h"
#include "shape/vertex_light.h"

namespace skinglow {
namespace detail {

/// Exitance of each site by light, of white light, and by the world.
struct LightMatrices {
    std::vector<ShapeData::Matrices> lights;  ///< empty for one that gives nothing
    ShapeData::Colors world;                  ///< empty without one
};

/// What a lit shape holds.
struct LitShapeData {
    std::shared_ptr<const ShapeData> shape;
    PreparedRig rig;
    ShapeLightOptions options;
    std::optional<Environment> environment;
    std::optional<Occluders> occluders;
    std::vector<std::size_t> left_out;
    std::vector<glm::dvec3> exitance;
    std::vector<glm::dvec3> transmitted;
    std::vector<glm::dvec3> irradiance;
    std::vector<std::uint8_t> wanted;
    Lazy<LightMatrices> matrices;

    VertexLight vertex_light() const {
        return {shape->solver.surface(),
                shape->vertices,
                shape->solver.vertex_sites(),
                shape->options.unit_mm,
                wanted,
                ShadowOptions{occluders ? &*occluders : nullptr, options.excluded, options.shadow_samples,
                              shape->options.threads}};
    }
    const LightMatrices& by_light() const;
    std::vector<glm::dvec3> sum(std::span<const glm::dvec3> colors,
                                std::vector<glm::mat3> ShapeData::Matrices::*of,
                                std::span<const glm::dvec3> world) const;
};

const LightMatrices& LitShapeData::by_light() const {
    return matrices.get([&] {
        const VertexLight light = vertex_light();
        LightMatrices result;
        for (const RigLight& one : rig.data().prepared) {
            result.lights.emplace_back();
            const std::vector<float> white = light.of_light(one);
            if (std::any_of(white.begin(), white.end(), [](float e) { return e != 0; }))
                result.lights.back() = shape->matrices(white, options.reentries);
        }
        if (environment) {
            const std::vector<glm::vec3> world = light.of_environment(*environment);
            const std::vector<glm::dvec3> irradiance_of_world(world.begin(), world.end());
            result.world = shape->solve(irradiance_of_world, options.reentries);
        }
        return result;
    });
}

/// Sum over the lights at the sites, of lights of these colors, and the world.
/// @param of     the matrices of a light
/// @param world  of each site; may be empty
std::vector<glm::dvec3> LitShapeData::sum(std::span<const glm::dvec3> colors,
                                          std::vector<glm::mat3> ShapeData::Matrices::*of,
                                          std::span<const glm::dvec3> world) const {
    const std::size_t sites = shape->solver.sites().sites().size();
    std::vector<glm::vec3> result(sites, glm::vec3(0.0F));
    std::copy(world.begin(), world.end(), result.begin());
    for (std::size_t k = 0; k < colors.size(); ++k) {
        const std::vector<glm::mat3>& matrices_of = by_light().lights[k].*of;
        const glm::vec3 color = colors[k];
        for (std::size_t s = 0; s < matrices_of.size(); ++s) {
            const glm::mat3& m = matrices_of[s];
            result[s] += shape->spectrum ? m * color : glm::vec3(m[0][0], m[1][1], m[2][2]) * color;
        }
    }
    std::vector<glm::dvec3> exact(sites);
    for (std::size_t s = 0; s < sites; ++s) exact[s] = glm::max(result[s], glm::vec3(0.0F));
    return exact;
}

}  // namespace detail

namespace {

/// Lights beyond this number are left out where all together bring less than this part of the light.
constexpr std::size_t many_lights = 32;
/// No more lights than channels.
constexpr std::size_t few_lights = 3;
constexpr double negligible = 1e-3;
constexpr std::size_t probes = 64;
constexpr int max_reentries = 8;
constexpr int max_samples = 4096;

template <typename Value>
std::vector<Value> at_points(const std::vector<Value>& of_sites, const ShapeData& shape) {
    std::vector<Value> result;
    result.reserve(shape.points.size());
    for (const std::uint32_t s : shape.solver.sites().site_of()) result.push_back(of_sites[s]);
    return result;
}

/// Largest irradiance, without shadows, at some of the vertices.
double brightness(const ShapeData& shape, const PreparedRig& rig, std::span<const std::uint8_t> wanted) {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    const SurfaceSites& sites = shape.solver.vertex_sites();
    const std::size_t step = std::max<std::size_t>(1, wanted.size() / probes);
    for (std::size_t v = 0; v < wanted.size(); v += step) {
        points.push_back(shape.vertices[v]);
        normals.emplace_back(sites.sites()[sites.site_of()[v]].normal);
    }
    double largest = 0;
    for (const glm::dvec3& e : surface_irradiance(rig, points, normals, {.area_tolerance = 1e-3}))
        largest = std::max({largest, e.r, e.g, e.b});
    return largest;
}

/// Indices of the lights that count, ascending.
std::vector<std::size_t> lights_that_count(const ShapeData& shape, const PreparedRig& rig,
                                           std::span<const std::uint8_t> wanted) {
    if (shape.vertices.empty()) return {};
    const double tolerance = rig.size() > many_lights ? negligible * brightness(shape, rig, wanted) : 0.0;
    return rig.cull(box_of(std::span(shape.vertices)), tolerance).kept;
}

}  // namespace

LitShape Shape::light(const PreparedRig& rig, const ShapeLightOptions& options) const {
    if (options.reentries < 0 || options.reentries > max_reentries)
        refuse_argument("reentries", std::to_string(options.reentries), "0 to 8");
    if (options.shadow_samples < 1 || options.shadow_samples > max_samples)
        refuse_argument("shadow_samples", std::to_string(options.shadow_samples), "1 to 4096");
    const auto data = std::make_shared<LitShapeData>();
    data->shape = data_;
    data->rig = rig;
    data->options = options;
    if (options.environment != nullptr) data->environment = *options.environment;
    if (options.occluders != nullptr) data->occluders = *options.occluders;
    data->options.environment = nullptr;
    data->options.occluders = nullptr;
    data->wanted = data_->solver.wanted_vertices(options.reentries > 0);
    const VertexLight vertex_light = data->vertex_light();
    std::vector<glm::dvec3> irradiance(vertices(), glm::dvec3(0.0));
    const std::vector<std::size_t> kept = lights_that_count(*data_, rig, data->wanted);
    for (const std::size_t k : kept) {
        const RigLight& one = rig.data().prepared[k];
        const std::vector<float> white = vertex_light.of_light(one);
        for (std::size_t v = 0; v < white.size(); ++v)
            irradiance[v] += one.color * static_cast<double>(white[v]);
    }
    for (std::size_t k = 0; k < rig.size(); ++k) {
        if (!std::binary_search(kept.begin(), kept.end(), k)) data->left_out.push_back(k);
    }
    if (data->environment) {
        const std::vector<glm::vec3> world = vertex_light.of_environment(*data->environment);
        for (std::size_t v = 0; v < world.size(); ++v) irradiance[v] += glm::dvec3(world[v]);
    }
    ShapeData::Colors colors;
    if (data_->spectrum && rig.size() <= few_lights) {
        // Spectra of different lights are better put together one by one, and few are as fast that way.
        std::vector<glm::dvec3> own;
        for (const RigLight& one : rig.data().prepared) own.push_back(one.color);
        const LightMatrices& by_light = data->by_light();
        colors.exitance = data->sum(own, &ShapeData::Matrices::exitance, by_light.world.exitance);
        colors.reflected = data->sum(own, &ShapeData::Matrices::reflected, by_light.world.reflected);
    } else {
        colors = data_->solve(irradiance, options.reentries);
    }
    for (std::size_t s = 0; s < colors.exitance.size(); ++s)
        colors.reflected[s] = glm::max(colors.exitance[s] - colors.reflected[s], glm::dvec3(0.0));
    data->exitance = at_points(colors.exitance, *data_);
    data->transmitted = at_points(colors.reflected, *data_);
    data->irradiance = std::move(irradiance);
    LitShape result;
    result.data_ = data;
    return result;
}

const std::vector<glm::dvec3>& LitShape::exitance() const {
    return data_->exitance;
}
const std::vector<glm::dvec3>& LitShape::transmitted() const {
    return data_->transmitted;
}
const std::vector<glm::dvec3>& LitShape::irradiance() const {
    return data_->irradiance;
}
std::size_t LitShape::lights() const {
    return data_->rig.size();
}
const std::vector<std::size_t>& LitShape::left_out() const {
    return data_->left_out;
}

std::vector<glm::dvec3> LitShape::per_light() const {
    const LightMatrices& all = data_->by_light();
    const std::size_t points = data_->shape->points.size();
    std::vector<glm::dvec3> result(lights() * points, glm::dvec3(0.0));
    const auto& site_of = data_->shape->solver.sites().site_of();
    for (std::size_t k = 0; k < lights(); ++k) {
        const std::vector<glm::mat3>& matrices = all.lights[k].exitance;
        if (matrices.empty()) continue;
        const glm::vec3 color = data_->rig.data().prepared[k].color;
        for (std::size_t i = 0; i < points; ++i) {
            result[k * points + i] = glm::max(matrices[site_of[i]] * color, glm::vec3(0.0F));
        }
    }
    return result;
}

std::vector<glm::dvec3> LitShape::recolor(std::span<const glm::dvec3> colors) const {
    if (colors.size() != lights()) {
        refuse_argument("colors", std::to_string(colors.size()) + " of them",
                        "one for each of " + std::to_string(lights()) + " lights");
    }
    for (std::size_t k = 0; k < colors.size(); ++k) require_not_negative(entry_name("colors", k), colors[k]);
    const ShapeData::Colors& world = data_->by_light().world;
    return at_points(data_->sum(colors, &ShapeData::Matrices::exitance, world.exitance), *data_->shape);
}

}  // namespace skinglow
