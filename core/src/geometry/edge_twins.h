#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Of an edge that no other face has, or more than one.
constexpr std::uint32_t no_twin = std::numeric_limits<std::uint32_t>::max();

/// The other face's edge for each edge of a face. An edge goes by the corner it begins at, as the face lists them.
/// @param corners   vertex of each corner, faces one after another
/// @param begin     first corner of each face, and the number of corners as the last entry
/// @param vertices  above every corner
std::vector<std::uint32_t> edge_twins(std::span<const std::uint32_t> corners,
                                      std::span<const std::uint32_t> begin, std::size_t vertices);

}  // namespace skinglow::detail
