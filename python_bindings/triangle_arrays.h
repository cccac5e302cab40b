#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace skinglow::numpy {

/// (m, 3) whole numbers that 32 bits hold; the core checks them against the number of vertices.
/// @param name  for messages, as "triangles"
std::vector<glm::uvec3> to_triangles(pybind11::handle value, const std::string& name, std::size_t vertices);

}  // namespace skinglow::numpy
