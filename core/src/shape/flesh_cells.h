#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shape/voxel_grid.h"

namespace skinglow::detail {

/// Which voxels of a grid's box have their center in flesh. Cells that no triangle comes near are alike as
/// far as they hang together, and asked in blocks; where the mesh is open and the answer changes between
/// them, one by one.
/// @param wanted  not 0 where it matters, one per voxel
/// @return not 0: flesh, one per voxel; 0 where it does not matter
std::vector<std::uint8_t> find_flesh(const FleshSurface& surface, const VoxelGrid& grid,
                                     std::span<const std::uint8_t> wanted, int threads);

/// Whether the box of a triangle comes near a grid's box.
bool is_near(const Body& body, const BodyTriangle& t, const VoxelGrid& grid);

/// Parts along a triangle's edges so that none is longer than a length, 1 to 400.
int parts_of(const Body& body, const BodyTriangle& t, float length);

}  // namespace skinglow::detail
