#pragma once

#include <skinglow/mesh.h>

#include <glm/vec3.hpp>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Normals for smooth shading of a mesh that brings none: at each corner of a triangle the mean of those faces at its vertex
/// that meet the triangle's plane at less than the angle of a sharp edge, weighted by their angle at the vertex. So a
/// plate keeps its edges.
/// @param mesh         with each position as one vertex: where vertices are doubled an edge is sharp
/// @param sharp_angle  between the normals of faces, radians
/// @return three per triangle, unit; 0 for triangles without area
std::vector<glm::dvec3> smooth_normals(const MeshView& mesh, double sharp_angle);

}  // namespace skinglow::detail
