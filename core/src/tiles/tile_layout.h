#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "tiles/face_list.h"

namespace skinglow::detail {

constexpr std::uint32_t no_tile = 0xFFFFFFFF;

/// Which faces share a tile, and where in it their corners lie.
struct TileLayout {
    std::vector<glm::uvec2> sizes;  ///< of each tile in cells: one less than its texels; x >= y >= 1
    std::vector<std::uint32_t> tile_of_face;  ///< no_tile: none
    std::vector<glm::dvec2> in_tile;          ///< of each corner, from 0 to the size of its tile
};

/// @param twins    of edge_twins
/// @param wanted   one per face
/// @param spacing  in units of the face list, above 0
TileLayout tile_layout(const FaceList& faces, std::span<const std::uint32_t> twins,
                       std::span<const std::uint8_t> wanted, double spacing);

/// Where the tiles lie in the image.
struct PackedTiles {
    std::vector<glm::uvec2> corner;  ///< first texel of each
    std::size_t height = 0;
};

/// In shelves, the highest first.
PackedTiles pack(std::span<const glm::uvec2> sizes);

}  // namespace skinglow::detail
