#pragma once

#include <pybind11/pybind11.h>
#include <skinglow/mesh.h>

#include <string>

namespace skinglow::numpy {

/// A checked mesh from (n, 3) numbers and (m, 3) whole numbers; throws ValueError naming the array and its
/// entry.
/// @param prefix  put before "vertices" and "triangles" in messages, such as "meshes[2] "
TriangleMesh to_mesh(pybind11::handle vertices, pybind11::handle triangles, const std::string& prefix = {});

}  // namespace skinglow::numpy
