#include "rig/irradiance.h"

#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "radiometry/prepared_light.h"

namespace skinglow {
namespace {

/// One factor for all channels: a black channel stays exactly black.
glm::dvec3 colored(const Light& light, double per_power) {
    return light.color * (light.power * per_power);
}

glm::dvec3 facing(const Light& light, const glm::dvec3& point, double tolerance) {
    validate(light);
    if (!is_on(light)) return glm::dvec3(0.0);
    return colored(light, PreparedLight(light).facing_irradiance(point, tolerance));
}

}  // namespace

glm::dvec3 irradiance(const Light& light, const glm::dvec3& point, const glm::dvec3& normal,
                      double tolerance) {
    validate(light);
    require_finite("point", point);
    require_finite("normal", normal);
    if (normal == glm::dvec3(0.0)) refuse_argument("normal", to_text(normal), "a vector of length above 0");
    require_positive("tolerance", tolerance);
    if (!is_on(light)) return glm::dvec3(0.0);
    const double per_power = PreparedLight(light).irradiance(point, unit(normal), tolerance);
    return require_finite("irradiance of light \"" + light.name + "\"", colored(light, per_power));
}

std::vector<glm::dvec3> object_irradiances(std::span<const Light> lights, const glm::dvec3& point,
                                           double tolerance) {
    require_finite("point", point);
    require_positive("tolerance", tolerance);
    std::vector<glm::dvec3> parts;
    parts.reserve(lights.size());
    for (const Light& light : lights) {
        parts.push_back(
            require_finite("irradiance of light \"" + light.name + "\"", facing(light, point, tolerance)));
    }
    return parts;
}

glm::dvec3 object_irradiance(std::span<const Light> lights, const glm::dvec3& point, double tolerance) {
    require_finite("point", point);
    require_positive("tolerance", tolerance);
    CompensatedSumRgb sum;
    for (const Light& light : lights) sum.add(facing(light, point, tolerance));
    return require_finite("sum of irradiance", sum.total());
}

}  // namespace skinglow
