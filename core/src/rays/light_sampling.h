#pragma once

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// A ray from a point to a point of a light.
struct LightSample {
    glm::dvec3 direction;  ///< unit length
    double distance;       ///< to the light's surface there; infinite for a sun
    double emission;       ///< what comes from there, before the receiver's cosine; 0 or more, any unit
};

/// Whether a light is so small from a point that one ray stands for all.
bool is_sharp(const PreparedLight& light, const glm::dvec3& point);

/// A ray to one of the points that cover a light. Uniform (u, v) in the unit square give samples that, each
/// weighted by emission times the receiver's cosine, stand for the light as PreparedLight has it: disks and
/// balls uniformly in solid angle, flat lights uniformly in area. From within a ball they cover the
/// hemisphere that is faced.
/// @param normal  unit length; only looked at within a ball
LightSample sample_light(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                         double u, double v);

}  // namespace skinglow::detail
