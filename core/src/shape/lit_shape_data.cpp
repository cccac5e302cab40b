#include "shape/lit_shape_data.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "numerics/job.h"
#include "rig/rig_data.h"
#include "shape/shape_error.h"

namespace skinglow::detail {
namespace {

/// Lights beyond this number are left out where all together bring less than this part of the light.
constexpr std::size_t many_lights = 32;
constexpr double negligible = 1e-3;
/// No more lights than channels.
constexpr std::size_t few_lights = 3;
constexpr std::size_t probes = 64;
/// Of a job: tracing the shadows of a light to a vertex, where making a site's rows is 1.
constexpr double work_of_traced = 0.005;

/// Largest irradiance, without shadows, at some of the vertices.
double brightness(const ShapeData& shape, const PreparedRig& rig) {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    const SurfaceSites& sites = shape.solver->vertex_sites();
    const std::size_t step = std::max<std::size_t>(1, shape.vertices.size() / probes);
    for (std::size_t v = 0; v < shape.vertices.size(); v += step) {
        points.push_back(shape.vertices[v]);
        normals.emplace_back(sites.sites()[sites.site_of()[v]].normal);
    }
    double largest = 0;
    for (const glm::dvec3& e : surface_irradiance(rig, points, normals, {.area_tolerance = 1e-3}))
        largest = std::max({largest, e.r, e.g, e.b});
    return largest;
}

/// Indices of the lights that count, ascending.
std::vector<std::size_t> lights_that_count(const ShapeData& shape, const PreparedRig& rig) {
    const double tolerance = rig.size() > many_lights ? negligible * brightness(shape, rig) : 0.0;
    return rig.cull(box_of(std::span(shape.vertices)), tolerance).kept;
}

}  // namespace

SolvedLight::SolvedLight(std::shared_ptr<const ShapeData> of, PreparedRig lights,
                         const ShapeLightOptions& given)
    : shape(std::move(of)), rig(std::move(lights)), options(given) {
    if (given.environment != nullptr) environment = *given.environment;
    if (given.occluders != nullptr) occluders = *given.occluders;
    options.environment = nullptr;
    options.occluders = nullptr;
    wanted = shape->solver->wanted_vertices(options.reentries > 0);
    sum_irradiance(vertex_light());
    require_irradiances("light at vertices", irradiance);
    // Spectra of different lights are better put together one by one, and few are as fast that way.
    if (shape->spectrum && rig.size() <= few_lights) {
        each();
    } else {
        together = shape->solve(irradiance, options.reentries);
    }
}

VertexLight SolvedLight::vertex_light() const {
    return {shape->solver->surface(),
            shape->vertices,
            shape->solver->vertex_sites(),
            shape->options.unit_mm,
            wanted,
            ShadowOptions{occluders ? &*occluders : nullptr, options.excluded, options.shadow_samples,
                          shape->options.threads}};
}

void SolvedLight::sum_irradiance(const VertexLight& light) {
    irradiance.assign(shape->vertices.size(), glm::dvec3(0.0));
    const std::vector<std::size_t> kept = lights_that_count(*shape, rig);
    const double work = work_of_traced * static_cast<double>(shape->vertices.size());
    expect_work(work * static_cast<double>(kept.size()));
    for (const std::size_t k : kept) {
        stop_if_asked();
        const RigLight& one = rig.data().prepared[k];
        const std::vector<float> white = light.of_light(one);
        for (std::size_t v = 0; v < white.size(); ++v)
            irradiance[v] += one.color * static_cast<double>(white[v]);
        finish_work(work);
    }
    for (std::size_t k = 0; k < rig.size(); ++k) {
        if (!std::binary_search(kept.begin(), kept.end(), k)) left_out.push_back(k);
    }
    if (!environment) return;
    const std::vector<glm::vec3> world = light.of_environment(*environment);
    for (std::size_t v = 0; v < world.size(); ++v) irradiance[v] += glm::dvec3(world[v]);
}

const NodeLights& SolvedLight::each() const {
    return by_light.get([&] {
        const VertexLight light = vertex_light();
        NodeLights result;
        const double work = work_of_traced * static_cast<double>(shape->vertices.size());
        const double of_light = work + shape->solver->solve_work(options.reentries);
        expect_work(of_light * static_cast<double>(rig.size()));
        for (const RigLight& one : rig.data().prepared) {
            stop_if_asked();
            const std::vector<float> white = light.of_light(one);
            require_irradiances("white light at vertices", white);
            result.lights.emplace_back();
            if (std::any_of(white.begin(), white.end(), [](float e) { return e != 0; })) {
                finish_work(work);
                result.lights.back() = shape->solve_white(white, options.reentries);
            } else {
                finish_work(of_light);
            }
        }
        if (environment) {
            const std::vector<glm::vec3> world = light.of_environment(*environment);
            const std::vector<glm::dvec3> of_world(world.begin(), world.end());
            result.world = shape->solve(of_world, options.reentries);
        }
        return result;
    });
}

void keep_transmitted(ShapeData::Colors& found) {
    for (std::size_t s = 0; s < found.exitance.size(); ++s)
        found.reflected[s] = glm::max(found.exitance[s] - found.reflected[s], glm::dvec3(0.0));
}

LitShapeData::LitShapeData(std::shared_ptr<const SolvedLight> light, std::shared_ptr<const ShapeData> colors)
    : solved(std::move(light)), shape(std::move(colors)) {
    ShapeData::Colors found;
    if (solved->together.empty()) {
        std::vector<glm::dvec3> own;
        for (const RigLight& one : solved->rig.data().prepared) own.push_back(one.color);
        found = sum(own);
    } else {
        found = shape->colors(solved->together);
    }
    keep_transmitted(found);
    exitance = shape->at_points(found.exitance);
    transmitted = shape->at_points(found.reflected);
}

const LightMatrices& LitShapeData::by_light() const {
    return matrices.get([&] {
        const NodeLights& nodes = solved->each();
        LightMatrices result;
        for (const SiteLight& one : nodes.lights) result.lights.push_back(shape->matrices(one));
        if (!nodes.world.empty()) result.world = shape->colors(nodes.world);
        return result;
    });
}

ShapeData::Colors LitShapeData::sum(std::span<const glm::dvec3> colors) const {
    const std::size_t sites = shape->solver->sites().sites().size();
    const auto total = [&](std::vector<glm::mat3> ShapeData::Matrices::*of,
                           std::span<const glm::dvec3> world) {
        std::vector<glm::dvec3> result(sites, glm::dvec3(0.0));
        std::copy(world.begin(), world.end(), result.begin());
        for (std::size_t k = 0; k < colors.size(); ++k) {
            const std::vector<glm::mat3>& matrices_of = by_light().lights[k].*of;
            for (std::size_t s = 0; s < matrices_of.size(); ++s) {
                const glm::mat3& m = matrices_of[s];
                result[s] += shape->spectrum ? glm::dmat3(m) * colors[k]
                                             : glm::dvec3(m[0][0], m[1][1], m[2][2]) * colors[k];
            }
        }
        for (glm::dvec3& e : result) e = glm::max(e, glm::dvec3(0.0));
        return result;
    };
    const ShapeData::Colors& world = by_light().world;
    return {total(&ShapeData::Matrices::exitance, world.exitance),
            total(&ShapeData::Matrices::reflected, world.reflected)};
}

std::vector<glm::dvec3> LitShapeData::error() const {
    std::vector<ColoredLight> lights;
    if (solved->together.empty()) {
        const NodeLights& nodes = solved->each();
        for (std::size_t k = 0; k < nodes.lights.size(); ++k)
            lights.push_back({&nodes.lights[k], solved->rig.data().prepared[k].color});
        add_colored(nodes.world, lights);
    } else {
        add_colored(solved->together, lights);
    }
    return estimated_error(*shape, lights, solved->irradiance);
}

}  // namespace skinglow::detail
