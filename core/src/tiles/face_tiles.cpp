#include <skinglow/face_tiles.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>

#include "geometry/edge_twins.h"
#include "numerics/argument_check.h"
#include "tiles/face_list.h"
#include "tiles/tile_layout.h"

namespace skinglow {
namespace {

/// Of the faces from the borders of their tiles, texels: single precision resolves it up to 16,384 rows.
constexpr double inset = 1e-3;
constexpr std::size_t max_max_texels = tile_image_width << 14U;
/// A spacing this many times the size of all faces leaves one texel a tile and direction.
constexpr double max_spacing = 4;

std::vector<std::uint8_t> wanted_faces(const FaceList& faces, std::span<const std::uint8_t> wanted) {
    std::vector<std::uint8_t> result(faces.faces(), wanted.empty() ? 1 : 0);
    if (wanted.empty()) return result;
    require_count("wanted", wanted.size(), faces.vertices(), "one per vertex");
    for (std::size_t face = 0; face < result.size(); ++face) {
        for (std::uint32_t c = faces.begin()[face]; c < faces.begin()[face + 1]; ++c)
            if (wanted[faces.corners()[c]] != 0) result[face] = 1;
    }
    return result;
}

}  // namespace

FaceTiles::FaceTiles(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> face_sizes,
                     std::span<const std::uint32_t> corners, std::span<const std::uint8_t> wanted,
                     const FaceTilesOptions& options)
    : spacing_mm_(require_positive("spacing_mm", options.spacing_mm)) {
    require_positive("unit_mm", options.unit_mm);
    require_between("max_texels", options.max_texels, tile_image_width, max_max_texels);
    const FaceList faces(vertices, face_sizes, corners);
    const std::vector<std::uint8_t> with_texels = wanted_faces(faces, wanted);
    const std::vector<std::uint32_t> twins = edge_twins(corners, faces.begin(), vertices.size());
    const std::size_t max_height = options.max_texels / tile_image_width;
    // A spacing of no more than rounding would be no length to divide by.
    const double asked = std::max(options.spacing_mm / options.unit_mm / faces.scale(), 1e-12);
    double spacing = asked;
    TileLayout layout;
    PackedTiles packed;
    while (true) {
        layout = tile_layout(faces, twins, with_texels, spacing);
        packed = pack(layout.sizes);
        if (packed.height <= max_height) break;
        if (spacing > max_spacing) {
            refuse_argument("max_texels", std::to_string(options.max_texels),
                            std::to_string(packed.height * tile_image_width) + " or more for " +
                                std::to_string(layout.sizes.size()) + " tiles of faces that share none");
        }
        const double excess = static_cast<double>(packed.height) / static_cast<double>(max_height);
        spacing *= std::clamp(std::sqrt(excess), 1.05, 4.0);
    }
    if (spacing != asked) spacing_mm_ *= spacing / asked;
    height_ = packed.height;
    tiles_ = layout.sizes.size();
    texels_.assign(corners.size(), glm::vec3(0.0F));
    for (std::size_t face = 0; face < faces.faces(); ++face) {
        const std::uint32_t tile = layout.tile_of_face[face];
        if (tile == no_tile) continue;
        for (std::uint32_t c = faces.begin()[face]; c < faces.begin()[face + 1]; ++c) {
            const glm::dvec2 at =
                glm::dvec2(packed.corner[tile]) +
                glm::clamp(layout.in_tile[c], glm::dvec2(inset), glm::dvec2(layout.sizes[tile]) - inset);
            texels_[c] = glm::vec3(at, static_cast<float>(tile + 1));
        }
    }
}

}  // namespace skinglow
