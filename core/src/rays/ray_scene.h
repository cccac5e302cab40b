#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "geometry/welded_mesh.h"
#include "rays/embree_triangles.h"

namespace skinglow::detail {

/// A mesh that rays go through, for its thickness. May be asked from many threads at once.
class RayScene {
  public:
    /// Builds the acceleration structure. The mesh must outlive the scene. Throws as EmbreeTriangles.
    explicit RayScene(const WeldedMesh& mesh);

    /// Fraction of the light of a uniform sky that reaches a triangle's outer side, [0, 1]:
    /// cosine-distributed rays from its center, those that nothing stops. 1 on a convex body, 0 in a closed
    /// cavity.
    /// @param directions  about +z, cosine-distributed
    double sky_visibility(std::uint32_t triangle, std::span<const glm::dvec3> directions) const;

    /// The triangle through which a ray leaves the flesh that starts at a welded vertex. Bodies within the
    /// body (an eyeball in a head) belong to the flesh: the ray ends where it has left as many bodies as it
    /// has entered. None where the mesh is open there, or the ray did not go in.
    /// @param direction  unit length
    /// @param dark       one per triangle: not 0 where rays pass as if it were not there; empty: none
    std::optional<std::uint32_t> exit_triangle(std::uint32_t welded, const glm::dvec3& direction,
                                               std::span<const std::uint8_t> dark) const;

  private:
    const WeldedMesh& mesh_;
    EmbreeTriangles triangles_;
};

}  // namespace skinglow::detail
