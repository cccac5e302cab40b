#pragma once

#include <skinglow/mesh.h>
#include <skinglow/rig.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// How much of each light arrives at a surface past other meshes.
///
/// @code
/// const std::vector<skinglow::MeshView> meshes = {skin, hat};
/// const skinglow::Occluders occluders(meshes, center_of_skin);
/// // The far side of the skin (far_side, rig.h), which the skin itself must not shadow:
/// const auto visible =
///     skinglow::visible_fraction(occluders, lights, far.points, far.normals, {.excluded = {0}});
/// @endcode
namespace skinglow {

namespace detail {
class OccluderScene;
}

/// What may stand between a light and a skin: triangles of several meshes, both sides of which stop light. In
/// single precision about an origin: what is seen from near it is seen to about 1e-7 of its distance, however
/// large the scene. May be asked from many threads at once.
class Occluders {
  public:
    /// Copies what it needs. Triangles without area stop nothing and are left out.
    /// @param meshes  world space, scene unit; none: nothing is in the way
    /// @param origin  near the points that will ask, finite; none: the center of all meshes
    /// @throws std::invalid_argument naming what is not allowed, std::runtime_error where Embree cannot work
    explicit Occluders(std::span<const MeshView> meshes,
                       const std::optional<glm::dvec3>& origin = std::nullopt);

    /// Number of meshes.
    std::size_t meshes() const;
    /// Number of triangles with area, of all meshes.
    std::size_t triangles() const;

    const detail::OccluderScene& scene() const { return *scene_; }

  private:
    std::shared_ptr<const detail::OccluderScene> scene_;
};

struct VisibilityOptions {
    /// Rays from a point to a light that has an extent, 1 to 4096; one ray goes to a light that has none. The
    /// error by number is in docs/accuracy.md.
    int samples = 16;
    std::vector<std::size_t> excluded = {};  ///< indices of meshes that do not count: the skin's own
    int threads = 0;                         ///< 0: one for each processor. The result does not depend on it.
};

struct VisibleFraction {
    /// Fraction of each light that arrives at each point, [0, 1]: point i, light k at [i * lights + k]. 1
    /// where the light contributes nothing anyway (below the horizon, outside the cone, off).
    std::vector<double> at_points;
    /// For each light the mean over the points, each weighted by the irradiance of the unoccluded light
    /// there: the factor on its part of the weight of a whole object. 1 where it contributes nothing at any
    /// point.
    std::vector<double> mean;
};

/// Fraction of each light that is visible from points that face along normals (for skin: its far side).
///
/// Rays go to points that cover the light, each weighted by the irradiance it contributes. They follow a
/// low-discrepancy sequence, shifted from point to point: nothing is random, and the mean over many points is
/// far more exact than any one.
/// @param occluders  what is in the way
/// @param lights     as everywhere; those that are off are not traced
/// @param points     world space, scene unit, finite
/// @param normals    one per point, finite, of any length; (0, 0, 0) receives nothing
/// @param options    see there
/// @throws std::invalid_argument naming the entry
VisibleFraction visible_fraction(const Occluders& occluders, const PreparedRig& lights,
                                 std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                                 const VisibilityOptions& options = {});

}  // namespace skinglow
