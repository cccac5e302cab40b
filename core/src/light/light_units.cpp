#include <skinglow/light.h>
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
    constexpr double pi = std::numbers::pi;
    const auto factor = [](const auto& shape) {
        if constexpr (requires { shape.radius; }) {
            return 4 * pi * shape.radius * shape.radius;
        } else if constexpr (requires { shape.sun_angle; }) {
            return pi * std::sin(0.5 * shape.sun_angle) * std::sin(0.5 * shape.sun_angle);
        } else {
            return shape.size_x * shape.size_y * (shape.area_shape == AreaShape::ellipse ? pi / 4 : 1.0);
        }
    };
    return std::visit(factor, light.shape());
}

glm::dvec3 black_body_color(double kelvin) {
    if (!(kelvin >= 800 && kelvin <= 20000))
        refuse_argument("temperature", to_text(kelvin), "800 to 20000 K");
    const glm::dvec3 color = spectral_color(blackbody_spectrum(kelvin));
    return {std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0)};
}

}  // namespace skinglow
