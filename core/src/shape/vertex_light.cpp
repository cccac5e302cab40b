#include "shape/vertex_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/spherical_harmonics.h"
#include "rays/direction_sampling.h"
#include "rays/occluder_scene.h"
#include "rays/visible_fraction.h"

namespace skinglow::detail {
namespace {

/// Relative error of the irradiance of one light.
constexpr double area_tolerance = 1e-4;
/// Rays that tell whether a vertex lies in a penumbra. To a light seen under less than narrow, whose penumbra is, one
/// goes first, and so many where a neighbor disagrees: most vertices at a shadow's edge lie in no penumbra.
constexpr int first_samples = 4;
constexpr double narrow = 0.1;  ///< sine of the angular radius
/// Rays to the world.
constexpr int sky_rays = 64;
/// Shadow rays begin this far outside, mm, or a small part of the body's size.
constexpr float lift_mm = 0.02F;
/// Of a vertex that does not receive light.
constexpr float no_light = -1;
constexpr std::size_t block = 256;

}  // namespace

VertexLight::VertexLight(const FleshSurface& surface, std::span<const glm::dvec3> vertices,
                         const SurfaceSites& sites, double unit_mm, std::span<const std::uint8_t> wanted,
                         const ShadowOptions& options)
    : surface_(surface), vertices_(vertices), sites_(sites), unit_mm_(unit_mm), options_(options) {
    for (std::uint32_t v = 0; v < wanted.size(); ++v) {
        if (wanted[v] != 0) wanted_.push_back(v);
    }
    receivers_.reserve(wanted_.size());
    for (const std::uint32_t v : wanted_) receivers_.push_back(receiver_of(v));
    for (const BodyTriangle& t : surface.body().triangles()) {
        if ((wanted[t.corners.x] | wanted[t.corners.y] | wanted[t.corners.z]) != 0)
            triangles_.push_back(t.corners);
    }
    if (options.occluders != nullptr) excluded_ = options.occluders->scene().triangles_of(options.excluded);
}

VertexLight::Receiver VertexLight::receiver_of(std::uint32_t vertex) const {
    const Site& site = sites_.sites()[sites_.site_of()[vertex]];
    const float lift = std::max(lift_mm, 4 * surface_.gap());
    const glm::dvec3 normal(site.normal);
    const double size = glm::length(normal);
    return {vertices_[vertex], site.position + site.normal * lift,
            size > 0 ? normal / size : glm::dvec3(0.0)};
}

bool VertexLight::sees(const Receiver& receiver, const glm::dvec3& direction, double distance) const {
    const double mm = std::min(distance * unit_mm_, static_cast<double>(std::numeric_limits<float>::max()));
    if (surface_.blocks(receiver.origin, direction, static_cast<float>(mm))) return false;
    if (options_.occluders == nullptr) return true;
    const RigidMotion& frame = options_.to_occluders;
    return !options_.occluders->scene().occluded(frame.point(receiver.point), frame.direction(direction),
                                                 distance, excluded_);
}

double VertexLight::fraction(const LightSampler& sampler, const Receiver& receiver, std::uint32_t vertex,
                             int samples) const {
    return visible_fraction_at(sampler, vertex, samples, [&](const LightSample& ray) {
        return sees(receiver, ray.direction, ray.distance);
    });
}

std::vector<std::uint8_t> VertexLight::doubtful(std::span<const float> fraction) const {
    std::vector<std::uint8_t> result(fraction.size(), 0);
    for (const glm::uvec3& corners : triangles_) {
        float low = 2;
        float high = -1;
        for (int k = 0; k < 3; ++k) {
            const float f = fraction[corners[k]];
            if (f == no_light) continue;
            low = std::min(low, f);
            high = std::max(high, f);
        }
        if (high <= low && (high == 0 || high == 1)) continue;
        for (int k = 0; k < 3; ++k) result[corners[k]] = 1;
    }
    return result;
}

WhiteIrradiance VertexLight::of_light(const PreparedLight& light, bool has_shadows) const {
    std::vector<float> seen(vertices_.size(), no_light);
    std::vector<double> open(wanted_.size(), 0.0);
    const auto first = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Receiver& receiver = receivers_[i];
            if (receiver.normal == glm::dvec3(0.0)) continue;
            open[i] = light.irradiance(receiver.point, receiver.normal, area_tolerance);
            if (!(open[i] > 0)) continue;
            const std::uint32_t v = wanted_[i];
            if (!has_shadows) {
                seen[v] = 1;
                continue;
            }
            const LightSampler sampler(light, receiver.point, receiver.normal);
            const int samples = sampler.sine() < narrow ? 1 : first_samples;
            seen[v] = static_cast<float>(fraction(sampler, receiver, v, std::min(samples, options_.samples)));
        }
    };
    for_each_block(wanted_.size(), options_.threads, first, {}, block);
    const std::vector<std::uint8_t> again =
        has_shadows ? doubtful(seen) : std::vector<std::uint8_t>(seen.size(), 0);
    const auto second = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t v = wanted_[i];
            if (seen[v] == no_light || again[v] == 0) continue;
            const Receiver& receiver = receivers_[i];
            const LightSampler sampler(light, receiver.point, receiver.normal);
            if (options_.samples > first_samples && sampler.sine() < narrow) {
                seen[v] = static_cast<float>(fraction(sampler, receiver, v, first_samples));
                if (seen[v] == 0 || seen[v] == 1) continue;
            }
            seen[v] = static_cast<float>(fraction(sampler, receiver, v, options_.samples));
        }
    };
    for_each_block(wanted_.size(), options_.threads, second, {}, block);
    WhiteIrradiance result{std::vector<float>(vertices_.size(), 0.0F)};
    for (std::size_t i = 0; i < open.size(); ++i) {
        open[i] = seen[wanted_[i]] == no_light ? 0.0 : open[i] * static_cast<double>(seen[wanted_[i]]);
        result.brightest = std::max(result.brightest, open[i]);
    }
    if (!(result.brightest > 0)) return result;
    for (std::size_t i = 0; i < open.size(); ++i)
        result.relative[wanted_[i]] = static_cast<float>(open[i] / result.brightest);
    return result;
}

std::vector<glm::vec3> VertexLight::of_environment(const Environment& environment) const {
    const auto directions = cosine_directions(sky_rays);
    std::vector<glm::vec3> result(vertices_.size(), glm::vec3(0.0F));
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Receiver& receiver = receivers_[i];
            if (receiver.normal == glm::dvec3(0.0)) continue;
            const glm::dmat3 frame = frame_around(receiver.normal);
            // The harmonics' sum over all rays is not exactly their integral: only what is hidden is summed.
            glm::dvec3 hidden(0.0);
            for (const glm::dvec3& local : directions) {
                const glm::dvec3 direction = frame * local;
                if (sees(receiver, direction, std::numeric_limits<double>::infinity())) continue;
                const auto harmonics = spherical_harmonics(direction);
                for (std::size_t k = 0; k < 9; ++k) hidden += environment.coefficients()[k] * harmonics[k];
            }
            const glm::dvec3 open = environment.irradiance(receiver.normal);
            const glm::dvec3 lost = hidden * (std::numbers::pi / sky_rays);
            result[wanted_[i]] = glm::clamp(open - lost, glm::dvec3(0.0), open);
        }
    };
    for_each_block(wanted_.size(), options_.threads, work, {}, block);
    return result;
}

}  // namespace skinglow::detail
