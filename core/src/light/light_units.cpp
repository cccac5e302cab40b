#include "light/light_units.h"

#include <skinglow/spectrum.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/argument_check.h"

namespace skinglow {

double legacy_sun_power_factor(double angle) {
    if (!(angle >= 0 && angle < std::numbers::pi))
        refuse_argument("angle", to_text(angle), "0 to below pi radians");
    const double cosine = std::cos(0.5 * angle);
    return 2 * cosine / (1 + cosine);
}

double exposure_factor(double stops) {
    require_finite("exposure", stops);
    return require_finite("2^exposure", std::exp2(stops));
}

double unnormalized_power_factor(const Light& light) {
    validate(light);
    constexpr double pi = std::numbers::pi;
    switch (light.kind) {
        case LightKind::sun:
            return pi * std::sin(0.5 * light.sun_angle) * std::sin(0.5 * light.sun_angle);
        case LightKind::area:
            return light.size_x * light.size_y * (light.area_shape == AreaShape::ellipse ? pi / 4 : 1.0);
        case LightKind::point:
        case LightKind::spot:
            return 4 * pi * light.radius * light.radius;
    }
    refuse_argument("light kind", std::to_string(static_cast<int>(light.kind)), "POINT, SUN, SPOT or AREA");
}

glm::dvec3 black_body_color(double kelvin) {
    if (!(kelvin >= 800 && kelvin <= 20000))
        refuse_argument("temperature", to_text(kelvin), "800 to 20000 K");
    const glm::dvec3 color = spectral_color(blackbody_spectrum(kelvin));
    return {std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0)};
}

}  // namespace skinglow
