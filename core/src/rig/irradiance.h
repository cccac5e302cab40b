#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "light/light.h"

/// What lamps bring to the skin, W/m^2 in linear Rec.709: the E of mode `physical` (docs/method.md), in place
/// of the paper's color times attenuation. Units are those of Blender's renderers, measured: a lamp of P
/// watts gives
///   point  P / (4 pi (d^2 + r^2)), r its radius as a disk that faces the point; a ball: P / (4 pi d^2)
///   spot   the same times the cone's profile (spot_profile.h)
///   sun    P, whatever the distance
///   area   P / (pi A) radiance, Lambert, from a rectangle or ellipse of area A, times the spread's profile
/// each cut off by the receiver's horizon. One unit of length is a meter. Lamps that are off give 0. Negative
/// power takes light away. A point at a lamp's very place faces it, and none is nearer than
/// min_light_distance (1e-6).
namespace skinglow {

/// Default relative tolerance of the integrals for elliptic lamps and spreads; the rest is in closed form.
constexpr double default_area_tolerance = 1e-7;

/// Irradiance of one lamp at a point whose surface faces along `normal`.
/// @param point   world, scene unit (meters); @param normal  any length but 0
/// @return W/m^2, linear Rec.709. Throws std::invalid_argument on a bad lamp, a non-finite point, a normal of
/// length 0, a tolerance not above 0, or where the result is beyond the largest double.
glm::dvec3 irradiance(const Light& light, const glm::dvec3& point, const glm::dvec3& normal,
                      double tolerance = default_area_tolerance);

/// Object weight, each lamp's part: irradiance at the point on a surface that faces the middle of the lamp,
/// so without the receiver's cosine (the paper's one lookup table per object has no normal).
/// @return one per light, in the order given. Errors as above.
std::vector<glm::dvec3> object_irradiances(std::span<const Light> lights, const glm::dvec3& point,
                                           double tolerance = default_area_tolerance);

/// The sum of `object_irradiances`: E for the whole object. (0,0,0) without lights; the order of the lights
/// does not matter beyond the last bits (compensated sum).
glm::dvec3 object_irradiance(std::span<const Light> lights, const glm::dvec3& point,
                             double tolerance = default_area_tolerance);

}  // namespace skinglow
