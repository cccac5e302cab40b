#pragma once

#include <skinglow/box.h>
#include <skinglow/rig.h>

#include <glm/vec3.hpp>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// What a unit of power can give on a surface that faces the light, anywhere in the box. The upper bound also
/// holds for any receiver orientation.
struct IrradianceRange {
    double min;
    double max;
};

/// Bounds that are proven, not estimated: each follows from the nearest and farthest distance, the smallest
/// and largest angle between the light's axis and the box, and the radiance of what glows; rounding and the
/// integrals' tolerance (default_area_tolerance) are added. Tight for a box small against its distance.
IrradianceRange irradiance_range(const PreparedLight& light, const Box& box);

/// Smallest angle that a vector of the ball (center, radius) makes with a unit axis; 0 where the ball holds
/// the origin.
double min_angle(const glm::dvec3& axis, const glm::dvec3& center, double radius);
/// The largest; pi where the ball holds the origin.
double max_angle(const glm::dvec3& axis, const glm::dvec3& center, double radius);

double distance_between(const Box& a, const Box& b);

/// Half the bounding box of an area light.
glm::dvec3 half_extent(const PreparedLight& light);

}  // namespace skinglow::detail
