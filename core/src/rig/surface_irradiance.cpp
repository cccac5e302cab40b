#include "rig/surface_irradiance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/prepared_light.h"

namespace skinglow {
namespace {

/// Without leaving early: so the loop is vectorized.
bool all_finite(std::span<const glm::dvec3> values) {
    constexpr double most = std::numeric_limits<double>::max();
    int bad = 0;
    for (const glm::dvec3& v : values) {
        bad |= static_cast<int>(!(std::abs(v.x) <= most)) | static_cast<int>(!(std::abs(v.y) <= most)) |
               static_cast<int>(!(std::abs(v.z) <= most));
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

std::vector<glm::dvec3> detail::sum_over_surface(std::span<const WeightedLight> lights,
                                                 std::span<const glm::dvec3> points,
                                                 std::span<const glm::dvec3> normals,
                                                 const SurfaceOptions& options) {
    const IrradianceSum lights_sum(lights, options.angular_weight, options.area_tolerance);
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
    for_each_block(points.size(), useful_threads(options.threads, points.size(), lights.size()), work, {},
                   512);
    if (is_finite) return sums;
    require_places(points, normals);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        require_finite("irradiance at points[" + std::to_string(i) + "]", sums[i]);
    }
    return sums;
}

void require_places(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
    require_a_normal_each(points, normals);
    const auto validate_all = [](const char* name, std::span<const glm::dvec3> values) {
        if (all_finite(values)) return;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::dvec3& v = values[i];
            if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
            refuse_argument(std::string(name) + "[" + std::to_string(i) + "]", to_text(v),
                            "three finite numbers");
        }
    };
    validate_all("points", points);
    validate_all("normals", normals);
}

std::vector<glm::dvec3> surface_irradiance(std::span<const Light> lights, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options) {
    require_a_normal_each(points, normals);
    require_positive("area_tolerance", options.area_tolerance);
    std::vector<PreparedLight> prepared;
    prepared.reserve(lights.size());
    std::vector<WeightedLight> weighted;
    for (const Light& light : lights) {
        validate(light);
        if (!is_on(light)) continue;
        prepared.emplace_back(light);
        weighted.push_back({&prepared.back(), light.color * light.power});
    }
    return sum_over_surface(weighted, points, normals, options);
}

Places far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                std::span<const double> depth) {
    require_places(vertices, normals);
    if (depth.size() != vertices.size() && depth.size() != 1) {
        refuse_argument("number of depths", std::to_string(depth.size()),
                        "1 or as many as vertices (" + std::to_string(vertices.size()) + ")");
    }
    for (std::size_t i = 0; i < depth.size(); ++i) {
        // The name is only put together where it is needed: this is a large part of the time otherwise.
        if (!(depth[i] >= 0.0 && std::isfinite(depth[i])))
            require_not_negative("depth[" + std::to_string(i) + "]", depth[i]);
    }
    Places far{std::vector<glm::dvec3>(vertices.size()), std::vector<glm::dvec3>(vertices.size())};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (normals[i] != glm::dvec3(0.0)) far.normals[i] = -unit(normals[i]);
        far.points[i] = vertices[i] + far.normals[i] * (depth.size() == 1 ? depth[0] : depth[i]);
    }
    return far;
}

std::vector<glm::dvec3> far_side_irradiance(std::span<const Light> lights,
                                            std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth, const SurfaceOptions& options) {
    const Places far = far_side(vertices, normals, depth);
    return surface_irradiance(lights, far.points, far.normals, options);
}

}  // namespace skinglow
