#pragma once

#include <skinglow/mesh.h>

#include <cstdint>

#include "geometry/weld.h"

namespace skinglow::detail {

/// A triangle with area: corners as welded vertices, and its plane.
struct WeldedTriangle {
    glm::uvec3 corners;
    glm::dvec3 unit_normal;  ///< outward
    double plane;            ///< dot(unit_normal, point) for every point of the plane
};

/// A mesh prepared for rays: vertices at one position are one vertex (the seams of texture coordinates and of
/// split normals are gone), triangles without area are gone, and the whole is moved to the origin and scaled
/// to the unit box, so that single precision serves a mesh of any size, anywhere. Outward is where the
/// triangles' winding says, flipped as a whole where the mesh encloses a negative volume.
class WeldedMesh {
  public:
    /// @throws std::invalid_argument where the extent of the mesh is beyond the largest double
    explicit WeldedMesh(const MeshView& mesh);

    /// Positions in the unit box, [-0.5, 0.5].
    const std::vector<glm::dvec3>& positions() const { return positions_; }
    const std::vector<WeldedTriangle>& triangles() const { return triangles_; }
    /// For each vertex given, its welded one.
    const std::vector<std::uint32_t>& welded_of() const { return weld_.index; }
    /// For each welded vertex a unit vector out of the surface, the faces weighted by their angle at the vertex (Thuermer and
    /// Wuethrich, "Computing Vertex Normals from Polygonal Facets", J. Graphics Tools 3(1), 1998); (0, 0, 0)
    /// where the faces cancel out or there are none.
    const std::vector<glm::dvec3>& normals() const { return normals_; }
    /// Length of the unit box's edge in the units given; 0 where all vertices coincide.
    double scale() const { return scale_; }
    /// Diagonal of the bounding box of all that triangles use, in the units given.
    double diagonal() const { return diagonal_; }

  private:
    void normalize(const MeshView& mesh);
    void add_triangles(std::span<const glm::uvec3> triangles);
    void orient_outwards();
    void add_normals();

    Weld weld_;
    std::vector<glm::dvec3> positions_;
    std::vector<WeldedTriangle> triangles_;
    std::vector<glm::dvec3> normals_;
    double scale_ = 0;
    double diagonal_ = 0;
};

}  // namespace skinglow::detail
