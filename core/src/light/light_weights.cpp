#include <skinglow/light_weights.h>

#include <cmath>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"

namespace skinglow {
namespace {

/// Eq. 2 for checked arguments.
double attenuation_at(double distance, const AttenuationCoefficients& k) {
    // Horner's form: d * d alone would overflow to inf, and inf * 0 be NaN, for a coefficient of 0.
    const double denominator = k.constant + distance * (k.linear + distance * k.quadratic);
    return denominator > 1.0 ? 1.0 / denominator : 1.0;
}

glm::dvec3 weight_of(const Light& light, const glm::dvec3& point,
                     const AttenuationCoefficients& coefficients) {
    if (!is_on(light)) return glm::dvec3(0.0);
    if (light.kind() == LightKind::sun) return light.color();
    return light.color() * attenuation_at(light_distance(light, point), coefficients);
}

}  // namespace

void validate(const AttenuationCoefficients& coefficients) {
    require_not_negative("attenuation coefficient k_c (constant)", coefficients.constant);
    require_not_negative("attenuation coefficient k_l (linear)", coefficients.linear);
    require_not_negative("attenuation coefficient k_q (quadratic)", coefficients.quadratic);
}

double attenuation(double distance, const AttenuationCoefficients& coefficients) {
    validate(coefficients);
    return attenuation_at(require_not_negative("distance", distance), coefficients);
}

double light_distance(const Light& light, const glm::dvec3& point) {
    if (light.kind() == LightKind::sun) return 0.0;
    const double distance = length(light.position() - point);
    if (!std::isfinite(distance)) {
        refuse_argument("distance of light \"" + light.name() + "\"", to_text(distance),
                        "points a finite distance apart");
    }
    return distance;
}

std::vector<glm::dvec3> light_weights(std::span<const Light> lights, const glm::dvec3& point,
                                      const AttenuationCoefficients& coefficients) {
    validate(coefficients);
    require_finite("point", point);
    std::vector<glm::dvec3> weights;
    weights.reserve(lights.size());
    for (const Light& light : lights) weights.push_back(weight_of(light, point, coefficients));
    return weights;
}

glm::dvec3 light_weight(std::span<const Light> lights, const glm::dvec3& point,
                        const AttenuationCoefficients& coefficients) {
    validate(coefficients);
    require_finite("point", point);
    CompensatedSumRgb sum;
    for (const Light& light : lights) sum.add(weight_of(light, point, coefficients));
    return require_finite("sum of light weights", sum.total());
}

}  // namespace skinglow
