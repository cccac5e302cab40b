#include <skinglow/environment.h>
#include <skinglow/rig.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/irradiance_sum.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

/// No early exit, so that the loop is vectorized.
bool all_finite(std::span<const glm::dvec3> values) {
    constexpr double max = std::numeric_limits<double>::max();
    int bad = 0;
    for (const glm::dvec3& v : values) {
        bad |= static_cast<int>(!(std::abs(v.x) <= max)) | static_cast<int>(!(std::abs(v.y) <= max)) |
               static_cast<int>(!(std::abs(v.z) <= max));
    }
    return bad == 0;
}

int useful_threads(int wanted, std::size_t points, std::size_t lights) {
    // A thread costs some 20 us to start, a point and light about 4 ns.
    const std::size_t useful = points * std::max<std::size_t>(lights, 1) / 32768 + 1;
    const std::size_t allowed =
        wanted > 0 ? static_cast<std::size_t>(wanted) : std::max(1U, std::thread::hardware_concurrency());
    return static_cast<int>(std::min(useful, allowed));
}

void require_a_normal_each(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
    if (points.size() == normals.size()) return;
    refuse_argument("number of normals", std::to_string(normals.size()),
                    "as many as points (" + std::to_string(points.size()) + ")");
}

}  // namespace

void detail::require_surface(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
    require_a_normal_each(points, normals);
    const auto validate_all = [](const char* name, std::span<const glm::dvec3> values) {
        if (all_finite(values)) return;
        for (std::size_t i = 0; i < values.size(); ++i) require_finite(entry_name(name, i), values[i]);
    };
    validate_all("points", points);
    validate_all("normals", normals);
}

std::vector<glm::dvec3> surface_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options) {
    require_a_normal_each(points, normals);
    require_positive("area_tolerance", options.area_tolerance);
    const IrradianceSum lights_sum(rig.data().prepared, options.angular_weight, options.area_tolerance);
    std::vector<glm::dvec3> sums(points.size());
    std::atomic<bool> is_finite = true;
    const auto work = [&](std::size_t begin, std::size_t end) {
        const auto block = std::span(sums).subspan(begin, end - begin);
        lights_sum.add(points.subspan(begin, block.size()), normals.subspan(begin, block.size()), block);
        if (options.environment != nullptr) {
            for (std::size_t i = begin; i < end; ++i) {
                if (normals[i] == glm::dvec3(0.0)) continue;
                sums[i] += options.environment->irradiance(unit(normals[i]), options.angular_weight);
            }
        }
        if (!all_finite(block)) is_finite = false;
    };
    for_each_block(points.size(), useful_threads(options.threads, points.size(), lights_sum.lights().size()),
                   work, {}, 512);
    if (is_finite) return sums;
    require_surface(points, normals);
    for (std::size_t i = 0; i < sums.size(); ++i)
        require_finite(entry_name("irradiance at points", i), sums[i]);
    return sums;
}

SurfacePoints far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                       std::span<const double> depth) {
    require_surface(vertices, normals);
    if (depth.size() != vertices.size() && depth.size() != 1) {
        refuse_argument("number of depths", std::to_string(depth.size()),
                        "1 or as many as vertices (" + std::to_string(vertices.size()) + ")");
    }
    for (std::size_t i = 0; i < depth.size(); ++i) require_not_negative(entry_name("depth", i), depth[i]);
    SurfacePoints far{std::vector<glm::dvec3>(vertices.size()), std::vector<glm::dvec3>(vertices.size())};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (normals[i] != glm::dvec3(0.0)) far.normals[i] = -unit(normals[i]);
        far.points[i] = vertices[i] + far.normals[i] * (depth.size() == 1 ? depth[0] : depth[i]);
    }
    return far;
}

std::vector<glm::dvec3> far_side_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth, const SurfaceOptions& options) {
    const SurfacePoints far = far_side(vertices, normals, depth);
    return surface_irradiance(rig, far.points, far.normals, options);
}

}  // namespace skinglow
