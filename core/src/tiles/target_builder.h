#pragma once

#include <skinglow/mesh.h>

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "geometry/weld.h"
#include "tiles/texel_triangle.h"
#include "tiles/unit_box.h"

namespace skinglow::detail {

/// Points of the triangles of a mesh.
struct SurfacePoints {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    std::vector<glm::uvec3> corners;  ///< of the triangle of each point
    std::vector<glm::dvec3> weights;  ///< of its corners, of sum 1
};

/// Makes the targets of texels, one for all texels at a corner of triangles or at a point of an edge.
class TargetBuilder {
  public:
    /// @param texels      how many there are at most
    /// @param texel_size  in the unit box
    TargetBuilder(const MeshView& mesh, const UnitBox& to_unit, std::size_t texels, double texel_size);

    /// The target of a texel that a triangle covers, or touches.
    std::int32_t within(const glm::uvec3& corners, const TexelTriangle& triangle, const glm::dvec2& texel);
    /// The target of one that it does not.
    std::int32_t beyond(const glm::uvec3& corners, const TexelTriangle& triangle, const glm::dvec2& texel);

    SurfacePoints targets() && { return std::move(targets_); }

  private:
    static constexpr std::int32_t none = -1;
    struct OnEdge {
        std::uint32_t low, high;  ///< ends of the edge
        double fraction;          ///< of the way from low to high
        std::int32_t target;
        std::int32_t next;  ///< with the same hash
    };

    std::int32_t add(const glm::uvec3& corners, const glm::dvec3& weights);

    const MeshView& mesh_;
    const UnitBox& to_unit_;
    double max_extension_;
    Weld welded_;
    std::vector<glm::dvec3> normals_;  ///< of welded vertices
    std::vector<std::int32_t> of_vertex_;
    std::vector<std::int32_t> heads_;  ///< first of on_edges_ with a hash
    std::vector<OnEdge> on_edges_;
    SurfacePoints targets_;
};

}  // namespace skinglow::detail
