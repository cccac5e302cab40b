#pragma once

#include <skinglow/occlusion.h>

#include "rays/embree_triangles.h"

namespace skinglow::detail {

/// The meshes of Occluders in single precision, in a frame about their origin.
class OccluderScene {
  public:
    /// As Occluders.
    OccluderScene(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin);

    std::size_t meshes() const { return ranges_.size(); }
    std::size_t triangles() const { return ranges_.empty() ? 0 : ranges_.back().end; }

    /// The triangles of some meshes; throws std::invalid_argument on an index that is out of range.
    std::vector<TriangleRange> triangles_of(std::span<const std::size_t> meshes) const;

    /// Whether a triangle lies between a point and what is at a distance along a direction. Surfaces that
    /// touch either end do not count: the ray begins and ends 1e-6 of its coordinates (about the origin)
    /// short.
    /// @param point      world, finite
    /// @param direction  unit length
    /// @param distance   0 or more, may be infinite
    /// @param excluded   triangles that do not count
    bool occluded(const glm::dvec3& point, const glm::dvec3& direction, double distance,
                  std::span<const TriangleRange> excluded = {}) const;

  private:
    void fit(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin);
    glm::dvec3 local(const glm::dvec3& point) const;

    std::vector<TriangleRange> ranges_;  ///< one per mesh
    glm::dvec3 origin_{0.0};
    double scale_ = 0;  ///< largest coordinate of a triangle's corner about the origin; 0: no triangles
    Box bounds_;        ///< of all triangles, local
    std::unique_ptr<EmbreeTriangles> triangles_;
};

}  // namespace skinglow::detail
