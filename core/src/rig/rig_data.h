#pragma once

#include <skinglow/light.h>
#include <skinglow/rig.h>
#include <skinglow/surface_lighting.h>

#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

class LightTree;

struct RigData {
    explicit RigData(std::vector<Light> given);
    /// Made by the first call.
    const LightTree& tree() const;

    const std::vector<Light> lights;
    std::vector<RigLight> prepared;  ///< one per light, in their order

  private:
    mutable std::once_flag tree_made_;
    mutable std::shared_ptr<const LightTree> tree_;
};

/// Throws std::invalid_argument unless there are as many normals as points, all finite; names the entry.
void require_surface(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals);

/// Unit vector of a normal of any length; throws std::invalid_argument where it is 0 or not finite.
glm::dvec3 unit_normal(const glm::dvec3& normal);

/// A light as terms: one, or for an area light columns x rows tiles (of an ellipse 1, 2, 4 or 8).
/// @param strength  power times color
/// @param center    of the object, where a ball is exact
std::vector<SurfaceTerm> surface_terms(const PreparedLight& light, const glm::dvec3& strength,
                                       const glm::dvec3& center, int columns = 1, int rows = 1);

}  // namespace skinglow::detail
