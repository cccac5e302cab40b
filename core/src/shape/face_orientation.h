#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shape/body.h"

namespace skinglow::detail {

/// Triangles whose winding is against that of the piece they belong to. Pieces hang together by edges that
/// two triangles share; in each the winding of the larger area is right.
/// @return one per triangle
std::vector<bool> against_neighbors(std::span<const BodyTriangle> triangles);

}  // namespace skinglow::detail
