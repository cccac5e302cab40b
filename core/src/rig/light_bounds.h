#pragma once

#include <skinglow/box.h>

#include <glm/vec3.hpp>
#include <span>

#include "light/light.h"
#include "radiometry/prepared_light.h"
#include "rig/irradiance.h"

namespace skinglow {

/// What a unit of power can give on a surface that faces the lamp, anywhere in the box. The upper bound holds
/// for every normal too: no normal gets more than the bound, because of what a lamp shines nothing is counted
/// twice.
struct IrradianceRange {
    double min;
    double max;
};

/// Bounds that are proven, not estimated: each follows from the nearest and farthest distance, the smallest
/// and largest angle between the lamp's axis and the box, and the radiance of what glows; rounding and the
/// integrals' tolerance (default_area_tolerance) are added. Tight for a box small against its distance.
IrradianceRange irradiance_range(const PreparedLight& light, const Box& box);

/// Smallest angle that a vector of the ball (middle, radius) makes with a unit axis; 0 where the ball holds
/// the origin.
double min_angle(const glm::dvec3& axis, const glm::dvec3& middle, double radius);
/// The largest; pi where the ball holds the origin.
double max_angle(const glm::dvec3& axis, const glm::dvec3& middle, double radius);

/// A cone of directions: all within `half_angle` of `axis`.
struct NormalCone {
    glm::dvec3 axis{0.0, 0.0, 1.0};         ///< unit
    double half_angle = 3.141592653589793;  ///< radians, 0 to pi (every direction)
};

/// The cone about the mean of normals (any length, those of 0 left out) that holds them all; every direction
/// where they cancel out or there are none. Throws std::invalid_argument on a normal that is not finite.
NormalCone normal_cone(std::span<const glm::dvec3> normals);

/// How far the object weight taken at `point` can be off anywhere in the box, each channel: an upper bound of
/// |object_irradiance(lights, p) - object_irradiance(lights, point)| over the points p of the box. It tells
/// how much the distance and the cones vary over the object; the receiver's cosine, which an object weight
/// leaves out, is not in it.
/// @return W/m^2, linear Rec.709. Throws std::invalid_argument on bad input.
glm::dvec3 object_irradiance_error(std::span<const Light> lights, const glm::dvec3& point, const Box& box);

/// The same with the receiver's cosine: an upper bound of |irradiance(lights, p, n) -
/// object_irradiance(lights, point)| over the points p of the box and the normals n of the cone. This is what
/// one weight for the whole object costs against weights at each place. @param facing  normals of the far
/// side
glm::dvec3 object_irradiance_error(std::span<const Light> lights, const glm::dvec3& point, const Box& box,
                                   const NormalCone& facing);

}  // namespace skinglow
