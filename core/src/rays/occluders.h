#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rays/embree_triangles.h"

namespace skinglow {

/// A mesh that somebody else holds.
struct MeshView {
    std::span<const glm::dvec3> vertices;
    std::span<const glm::uvec3> triangles;
};

/// What may stand between a lamp and a skin: triangles of several meshes, both sides of which stop light. In
/// single precision about a place of its own: what is seen from near that place is seen to about 1e-7 of its
/// distance, however large the scene. All that is const may be called from many threads at once.
class Occluders {
  public:
    /// Copies what it needs. Triangles without area stop nothing and are left out.
    /// @param meshes  world, scene unit; none: nothing stands in the way
    /// @param origin  near the places that will ask; none: the middle of all meshes
    /// Throws std::invalid_argument naming the mesh and its entry, std::runtime_error where Embree cannot
    /// work.
    explicit Occluders(std::span<const MeshView> meshes,
                       const std::optional<glm::dvec3>& origin = std::nullopt);

    std::size_t meshes() const { return ranges_.size(); }
    /// Those with area.
    std::size_t triangles() const { return ranges_.empty() ? 0 : ranges_.back().end; }

    /// The triangles of some meshes; throws std::invalid_argument on an index that is out of range.
    std::vector<TriangleRange> triangles_of(std::span<const std::size_t> meshes) const;

    /// Whether something stands between a point and what lies at a distance along a direction. Surfaces that
    /// touch either end do not count: the way begins and ends 1e-6 of its coordinates (about the origin)
    /// short.
    /// @param point  world, finite; @param direction  unit; @param distance  0 or more, may be infinite
    /// @param without  triangles that do not count
    bool between(const glm::dvec3& point, const glm::dvec3& direction, double distance,
                 std::span<const TriangleRange> without = {}) const;

  private:
    glm::dvec3 local(const glm::dvec3& point) const;
    void place(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin);

    std::vector<TriangleRange> ranges_;  ///< one per mesh
    glm::dvec3 origin_{0.0};
    double scale_ = 0;  ///< largest coordinate of a triangle's corner about the origin; 0: no triangles
    glm::dvec3 least_{0.0}, most_{0.0};  ///< the box of all triangles, local
    std::unique_ptr<EmbreeTriangles> triangles_;
};

}  // namespace skinglow
