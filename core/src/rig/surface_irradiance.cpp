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

void detail::require_surface(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
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

std::vector<glm::dvec3> surface_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options) {
    require_a_normal_each(points, normals);
    require_positive("area_tolerance", options.area_tolerance);
    std::vector<WeightedLight> lights;
    for (const RigLight& one : rig.data().prepared) {
        if (one.shines) lights.push_back({&one.light, one.strength()});
    }
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
    require_surface(points, normals);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        require_finite("irradiance at points[" + std::to_string(i) + "]", sums[i]);
    }
    return sums;
}

}  // namespace skinglow
