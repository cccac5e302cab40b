#pragma once

#include <glm/vec3.hpp>
#include <numbers>

#include "light/light.h"

/// Numbers with which a reader of a host's lamps turns its settings into `Light::color` and `Light::power`.
namespace skinglow {

/// Blender before 4.0 makes a far area lamp P / (4 d^2) bright, later versions and this library P / (pi d^2):
/// multiply the power of such a lamp by this. Measured on 3.4.1.
constexpr double legacy_area_power_factor = std::numbers::pi / 4;

/// A sun of an angle gives less than its strength in Blender 3.4, whose samples are even on a plane and not
/// on the sky: 2 c / (1 + c), c = cos(angle / 2), on a surface that faces it. Multiply its power by this.
/// Measured on 3.4.1; 4.5 gives the strength.
/// @param angle  radians, 0 to below pi, else std::invalid_argument
double legacy_sun_power_factor(double angle);

/// 2^stops: the factor on the power for a lamp's exposure (Blender 4.5 and later).
/// @param stops  finite, and small enough that the factor is a double, else std::invalid_argument
double exposure_factor(double stops);

/// The factor on the power for a lamp whose `normalize` is off (Blender 4.5 and later): an area lamp's area,
/// a point or spot's 4 pi r^2, a sun's pi sin^2(angle/2). Power then means strength per area of the lamp.
/// Errors as `validate`.
double unnormalized_power_factor(const Light& light);

/// Color of a black body, linear Rec.709, of Rec.709 luminance 1, no channel below 0 (very red or blue light
/// is outside Rec.709 and is cut): multiplies a lamp's color, which keeps its luminance, as Blender's
/// `temperature` does.
/// @param kelvin  800 to 20000, Blender's range, else std::invalid_argument
glm::dvec3 black_body_color(double kelvin);

}  // namespace skinglow
