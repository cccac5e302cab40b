#pragma once

#include <skinglow/surface_lighting.h>

#include <glm/vec3.hpp>
#include <vector>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// A light as terms: one, or for an area light columns x rows tiles (of an ellipse 1, 2, 4 or 8).
/// @param strength  power times color
/// @param center    of the object, where a ball is exact
std::vector<SurfaceTerm> surface_terms(const PreparedLight& light, const glm::dvec3& strength,
                                       const glm::dvec3& center, int columns = 1, int rows = 1);

}  // namespace skinglow::detail
