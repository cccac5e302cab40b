#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/welded_mesh.h"
#include "rays/embree_triangles.h"

namespace skinglow {

/// A mesh that rays go through, for its thickness.
class RayScene {
  public:
    /// Builds the acceleration structure. The mesh must outlive the scene. Throws as EmbreeTriangles.
    explicit RayScene(const WeldedMesh& mesh);

    /// Share of the light of an even sky that reaches a triangle's outer side, [0, 1]: rays by Lambert's
    /// cosine from its middle, those that nothing stops. 1 on a convex body, 0 in a closed cavity.
    /// @param directions  about +z, by cosine
    double openness(std::uint32_t triangle, std::span<const glm::dvec3> directions) const;

    /// Closes triangles to light: rays pass them from now on as if they were not there.
    /// @param closed  one per triangle, not 0 where closed; empty for none
    void close(std::vector<std::uint8_t> closed) { closed_ = std::move(closed); }

    /// The triangle through which a ray leaves the flesh that starts at a welded vertex. Bodies within the
    /// body (an eyeball in a head) belong to the flesh and are passed through: what counts is the first way
    /// out of all. Nothing where there is none: the mesh is open there, or the ray did not go in. May be
    /// called from many threads at once. @param direction  unit length
    std::optional<std::uint32_t> exit_triangle(std::uint32_t welded, const glm::dvec3& direction) const;

  private:
    const WeldedMesh& mesh_;
    std::vector<std::uint8_t> closed_;
    EmbreeTriangles triangles_;
};

}  // namespace skinglow
