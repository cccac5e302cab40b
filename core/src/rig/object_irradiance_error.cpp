#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/light_bounds.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-9;

/// Smallest and largest fraction of its facing irradiance that a light gives to any normal of the cone,
/// anywhere in the box.
IrradianceRange cosine_range(const PreparedLight& light, const Box& box, const NormalCone& normals) {
    double spread = normals.half_angle + rounding;
    double radius = 0;  // angular, of the light seen from anywhere in the box
    if (light.kind() == LightKind::sun) {
        radius = std::asin(std::min(1.0, light.sin_sun_radius()));
    } else {
        const double extent = light.area() ? half_diagonal(light) : light.radius();
        const double nearest = box.min_distance(light.position());
        if (nearest <= extent || nearest <= min_light_distance) return {0.0, 1.0};
        spread += half_angle(light.distance(box.center()), box.radius());
        radius = std::asin(extent / nearest);
    }
    const double center_angle = angle_between(normals.axis, light.to_light(box.center()));
    const double smallest = std::max(0.0, center_angle - spread - radius);
    const double largest = std::min(pi, center_angle + spread + radius);
    // A facing receiver gets at least cos(radius) of what one without a cosine would.
    const double max = std::max(0.0, std::cos(smallest)) / std::max(std::cos(radius), rounding);
    return {std::max(0.0, std::cos(largest)), std::min(1.0, max)};
}

}  // namespace

NormalCone normal_cone(std::span<const glm::dvec3> normals) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& normal : normals) {
        require_finite("normals", normal);
        if (normal != glm::dvec3(0.0)) mean += unit(normal);
    }
    if (!(length(mean) > 1e-6 * static_cast<double>(normals.size()))) return {};
    NormalCone cone{unit(mean), 0.0};
    for (const glm::dvec3& normal : normals) {
        if (normal != glm::dvec3(0.0))
            cone.half_angle = std::max(cone.half_angle, angle_between(cone.axis, unit(normal)));
    }
    return cone;
}

glm::dvec3 object_irradiance_error(const PreparedRig& rig, const glm::dvec3& point, const Box& box,
                                   const std::optional<NormalCone>& normals) {
    validate(box);
    const glm::dvec3 here = object_irradiance(rig, point);
    CompensatedSumRgb min;
    CompensatedSumRgb max;
    for (const RigLight& one : rig.data().prepared) {
        if (!one.shines) continue;
        IrradianceRange range = irradiance_range(one.light, box);
        if (normals) {
            const IrradianceRange cosine = cosine_range(one.light, box, *normals);
            range = {range.min * cosine.min * (1 - rounding), range.max * cosine.max};
        }
        // Negative power swaps the ends.
        min.add(glm::min(one.scaled(range.min), one.scaled(range.max)));
        max.add(glm::max(one.scaled(range.min), one.scaled(range.max)));
    }
    const glm::dvec3 error = glm::max(glm::max(max.total() - here, here - min.total()), glm::dvec3(0.0));
    return require_finite("bound of the object weight's error", error);
}

}  // namespace skinglow
