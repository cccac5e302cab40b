#pragma once

#include <glm/vec3.hpp>

#include "radiometry/prepared_light.h"

namespace skinglow {

/// A way from a place to a point of a lamp.
struct LampSample {
    glm::dvec3 direction;  ///< unit, from the place
    double distance;       ///< to the lamp's surface there; infinite for a sun
    double emission;       ///< what comes from there, before the receiver's cosine; 0 or more, any unit
};

/// Whether a lamp is so small from a place that one way stands for all.
bool is_sharp(const PreparedLight& light, const glm::dvec3& point);

/// A way to one of the points that cover a lamp. Even (u, v) of the unit square give samples that, each
/// counted by emission times the receiver's cosine, stand for the lamp's light as PreparedLight has it: disks
/// and balls evenly in solid angle, flat lamps evenly in area. From within a ball they cover the hemisphere
/// that is faced.
/// @param normal  unit; only looked at within a ball
LampSample sample_lamp(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                       double u, double v);

}  // namespace skinglow
