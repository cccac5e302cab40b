#include "shape/vertex_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "geometry/vector.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/irradiance_sum.h"
#include "radiometry/spherical_harmonics.h"
#include "rays/direction_sampling.h"
#include "rays/occluder_scene.h"

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
constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Spreads ten bits: two zeros come between each and the next.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | x << 16U) & 0x030000FFU;
    x = (x | x << 8U) & 0x0300F00FU;
    x = (x | x << 4U) & 0x030C30C3U;
    return (x | x << 2U) & 0x09249249U;
}

}  // namespace

VertexLight::VertexLight(const FleshSurface& surface, std::span<const glm::dvec3> vertices,
                         const SurfaceSites& sites, double unit_mm, std::span<const std::uint8_t> wanted,
                         const ShadowOptions& options)
    : surface_(surface), vertices_(vertices), sites_(sites), unit_mm_(unit_mm), options_(options) {
    for (std::uint32_t v = 0; v < wanted.size(); ++v) {
        if (wanted[v] != 0) wanted_.push_back(v);
    }
    sort_by_position();
    for (const std::uint32_t v : wanted_) add_receiver(v);
    for (const BodyTriangle& t : surface.body().triangles()) {
        if ((wanted[t.corners.x] | wanted[t.corners.y] | wanted[t.corners.z]) != 0)
            triangles_.push_back(t.corners);
    }
    if (options.occluders != nullptr) excluded_ = options.occluders->scene().triangles_of(options.excluded);
}

/// Neighbors after each other, along the Z-order curve: their rays to a light are alike, and packets of them fast.
void VertexLight::sort_by_position() {
    std::vector<glm::vec3> positions;
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t v : wanted_) {
        positions.push_back(sites_.sites()[sites_.site_of()[v]].position);
        low = glm::min(low, positions.back());
        high = glm::max(high, positions.back());
    }
    constexpr float cells = 1023;  // 10 bits an axis
    constexpr float least_size =
        1e-30F;  // of positions in one plane: 1023 times its inverse is a number, too
    const glm::vec3 scale = cells / glm::max(high - low, glm::vec3(least_size));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    order.reserve(wanted_.size());
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
        const glm::uvec3 cell(glm::clamp((positions[i] - low) * scale, 0.0F, cells));
        order.emplace_back(spread_bits(cell.x) | spread_bits(cell.y) << 1U | spread_bits(cell.z) << 2U,
                           wanted_[i]);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < wanted_.size(); ++i) wanted_[i] = order[i].second;
}

void VertexLight::add_receiver(std::uint32_t vertex) {
    const Site& site = sites_.sites()[sites_.site_of()[vertex]];
    const float lift = std::max(lift_mm, 4 * surface_.gap());
    const glm::dvec3 normal(site.normal);
    const double size = glm::length(normal);
    points_.push_back(vertices_[vertex]);
    normals_.push_back(size > 0 ? normal / size : glm::dvec3(0.0));
    origins_.push_back(site.position + site.normal * lift);
}

float VertexLight::to_mm(double distance) const {
    return static_cast<float>(
        std::min(distance * unit_mm_, static_cast<double>(std::numeric_limits<float>::max())));
}

bool VertexLight::passes_occluders(const glm::dvec3& point, const glm::dvec3& direction,
                                   double distance) const {
    if (options_.occluders == nullptr) return true;
    const RigidMotion& frame = options_.to_occluders;
    return !options_.occluders->scene().occluded(frame.point(point), frame.direction(direction), distance,
                                                 excluded_);
}

/// Finds what some receivers see of a light.
/// @param is_asked  is_asked(receiver's index): whether it is one of them
/// @param samples   rays to the light from each
template <typename Asked>
void VertexLight::find_fractions(const PreparedLight& light, std::size_t begin, std::size_t end,
                                 const Asked& is_asked, int samples, std::span<float> seen) const {
    std::vector<Ray> rays;
    for (std::size_t i = begin; i < end; ++i) {
        if (!is_asked(i)) continue;
        const LightSampler sampler(light, points_[i], normals_[i]);
        for_each_light_sample(sampler, wanted_[i], samples, [&](const LightSample& ray, double weight) {
            rays.push_back({i, weight, ray});
        });
    }
    trace(rays, seen);
}

/// @param rays  those of a receiver after each other
void VertexLight::trace(std::span<const Ray> rays, std::span<float> seen) const {
    std::vector<RaySegment> segments;
    segments.reserve(rays.size());
    for (const Ray& ray : rays)
        segments.push_back({origins_[ray.receiver], ray.sample.direction, 0, to_mm(ray.sample.distance)});
    std::vector<std::uint8_t> is_blocked(rays.size());
    surface_.block(segments, is_blocked);
    for (std::size_t r = 0; r < rays.size();) {
        const std::size_t i = rays[r].receiver;
        double all = 0;
        double visible = 0;
        for (; r < rays.size() && rays[r].receiver == i; ++r) {
            all += rays[r].weight;
            if (is_blocked[r] == 0 &&
                passes_occluders(points_[i], rays[r].sample.direction, rays[r].sample.distance))
                visible += rays[r].weight;
        }
        seen[wanted_[i]] = static_cast<float>(std::min(1.0, visible / all));
    }
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
    std::vector<std::uint8_t> is_narrow(wanted_.size(), 0);
    const RigLight white{0, light, glm::dvec3(1.0), 1.0, !light.dark()};
    const IrradianceSum unshadowed(std::span(&white, 1), nullptr, area_tolerance);
    const auto first = [&](std::size_t begin, std::size_t end) {
        std::vector<glm::dvec3> found(end - begin, glm::dvec3(0.0));
        unshadowed.add(std::span(points_).subspan(begin, found.size()),
                       std::span(normals_).subspan(begin, found.size()), found);
        std::vector<Ray> to_center;
        for (std::size_t i = begin; i < end; ++i) {
            open[i] = found[i - begin].x;
            if (!(open[i] > 0)) continue;
            if (!has_shadows) {
                seen[wanted_[i]] = 1;
                continue;
            }
            const double distance = light.distance(points_[i]);
            if (!(LightSampler::sine_at(light, distance) < narrow)) continue;
            is_narrow[i] = 1;
            double length = unlimited;
            if (light.kind() != LightKind::sun)
                length = light.soft_falloff() ? distance : distance - light.radius();
            to_center.push_back({i, 1.0, {light.to_light(points_[i]), length, 1.0}});
        }
        trace(to_center, seen);
        const auto is_wide = [&](std::size_t i) { return has_shadows && open[i] > 0 && is_narrow[i] == 0; };
        find_fractions(light, begin, end, is_wide, std::min(first_samples, options_.samples), seen);
    };
    for_each_block(wanted_.size(), options_.threads, first, {}, block);
    const std::vector<std::uint8_t> again =
        has_shadows ? doubtful(seen) : std::vector<std::uint8_t>(seen.size(), 0);
    const auto second = [&](std::size_t begin, std::size_t end) {
        const auto is_asked = [&](std::size_t i) { return open[i] > 0 && again[wanted_[i]] != 0; };
        const auto has_steps = [&](std::size_t i) {
            return options_.samples > first_samples && is_narrow[i] != 0;
        };
        find_fractions(
            light, begin, end, [&](std::size_t i) { return is_asked(i) && has_steps(i); }, first_samples,
            seen);
        const auto is_in_part = [&](std::size_t i) {
            const float part = seen[wanted_[i]];
            return is_asked(i) && (!has_steps(i) || (part != 0 && part != 1));
        };
        find_fractions(light, begin, end, is_in_part, options_.samples, seen);
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
        std::vector<glm::dvec3> along(directions.size());
        std::vector<RaySegment> segments(directions.size());
        std::vector<std::uint8_t> is_blocked(directions.size());
        for (std::size_t i = begin; i < end; ++i) {
            if (normals_[i] == glm::dvec3(0.0)) continue;
            const glm::dmat3 frame = frame_around(normals_[i]);
            // The harmonics' sum over all rays is not exactly their integral: only what is hidden is summed.
            glm::dvec3 hidden(0.0);
            for (std::size_t r = 0; r < directions.size(); ++r) {
                along[r] = frame * directions[r];
                segments[r] = {origins_[i], along[r], 0, to_mm(unlimited)};
            }
            surface_.block(segments, is_blocked);
            for (std::size_t r = 0; r < directions.size(); ++r) {
                const glm::dvec3& direction = along[r];
                if (is_blocked[r] == 0 && passes_occluders(points_[i], direction, unlimited)) continue;
                const auto harmonics = spherical_harmonics(direction);
                for (std::size_t k = 0; k < 9; ++k) hidden += environment.coefficients()[k] * harmonics[k];
            }
            const glm::dvec3 open = environment.irradiance(normals_[i]);
            const glm::dvec3 lost = hidden * (std::numbers::pi / sky_rays);
            result[wanted_[i]] = glm::clamp(open - lost, glm::dvec3(0.0), open);
        }
    };
    for_each_block(wanted_.size(), options_.threads, work, {}, block);
    return result;
}

}  // namespace skinglow::detail
