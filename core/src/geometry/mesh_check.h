#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace skinglow {

/// Throws std::invalid_argument naming the first vertex that is not finite or triangle that is out of range,
/// or where 32 bits cannot count them. @param whose  goes before the name: "meshes[2] ", or nothing
void require_mesh(const std::string& whose, std::span<const glm::dvec3> vertices,
                  std::span<const glm::uvec3> triangles);

/// Whether a triangle's area is more than rounding, so that it has a normal and stops light.
/// @param doubled_area  length of the cross product of two edges; @param longest  square of the longest edge
bool has_area(double doubled_area, double longest);

}  // namespace skinglow
