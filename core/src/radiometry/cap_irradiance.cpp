#include "radiometry/cap_irradiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiometry/spread_integral.h"

namespace skinglow::detail {

double cap_irradiance(double cos_normal, double sin_radius) {
    if (cos_normal >= sin_radius) return cos_normal;
    if (cos_normal <= -sin_radius) return 0.0;
    const double cos_radius = std::sqrt(std::max(0.0, 1.0 - sin_radius * sin_radius));
    const double sin_normal = std::sqrt(std::max(0.0, 1.0 - cos_normal * cos_normal));
    const double rise = std::clamp(-cos_radius * cos_normal / (sin_radius * sin_normal), -1.0, 1.0);
    const double chord = sin_normal * std::sqrt(1.0 - rise * rise);
    // The patch's rim, (angle - tangent) / tan^2, and the horizon's, the angle: small patches by the series of the
    // difference, which would cancel.
    const double per_radius = chord / cos_radius;
    const double tangent = per_radius * sin_radius;
    const double rest = tangent < small_tangent
                            ? tangent * (1.0 - per_radius * per_radius * tangent_series(tangent * tangent))
                            : std::atan2(chord * sin_radius, cos_radius) / (sin_radius * sin_radius) -
                                  cos_radius * chord / sin_radius;
    return std::clamp((cos_normal * std::acos(rise) + rest) / std::numbers::pi, 0.0, 1.0);
}

}  // namespace skinglow::detail
