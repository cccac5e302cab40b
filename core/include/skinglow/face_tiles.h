#pragma once

#include <skinglow/mesh.h>

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// Values on a surface as texels of an image: each face has a tile of texels, which a renderer interpolates from
/// texel coordinates at the corners of the faces. Layout and measured errors: docs/face_tiles.md.
/// @code
/// const skinglow::FaceTiles layout(vertices, face_sizes, corners);
/// const skinglow::TileTargets targets(shown_mesh, texels_of_its_triangles, layout.height());
/// const std::vector<float> pixels = targets.spread(colors_of(targets.points()), 3);
/// @endcode
namespace skinglow {

/// Width of every image of tiles, texels.
constexpr std::size_t tile_image_width = 1024;

struct FaceTilesOptions {
    double unit_mm = 1.0;  ///< length of one unit of the vertices, mm; finite, above 0
    double spacing_mm =
        0.8;  ///< of texels along the edges of a face, to the nearest whole number; finite, above 0
    /// Most texels of the image, at least one row of it; where it binds, the spacing grows.
    std::size_t max_texels = std::size_t{1} << 20U;
};

/// Where in an image the faces of a mesh have their texels. Faces that share a tile:
/// - a quad has one of its own, with (nx + 1) x (ny + 1) texels, n the length of the longer of opposite edges over
///   the spacing, rounded, 1 or more. Two triangles that make up a quad share one; a triangle left over has half of
///   one, with its longest edge as the diagonal;
/// - faces of more corners lie in a tile as in their plane, and so do long thin ones where that takes far fewer
///   texels;
/// - connected faces whose edges are well below the spacing, and that face alike, share a plane.
class FaceTiles {
  public:
    /// @param vertices    positions, finite
    /// @param face_sizes  corners of each face, 3 or more
    /// @param corners     indices of vertices, those of one face after those of the other
    /// @param wanted      one per vertex, not 0: a face with such a corner gets texels; empty: all do
    /// @throws std::invalid_argument naming what is not allowed, also where the mesh has too many separate
    ///         faces for max_texels
    FaceTiles(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> face_sizes,
              std::span<const std::uint32_t> corners, std::span<const std::uint8_t> wanted = {},
              const FaceTilesOptions& options = {});

    /// For each corner x and y in texels, whose centers are the whole numbers, and z, 1 + the index of the tile.
    /// (0, 0, 0): no tile. A face does not touch its tile's border, by 1/1000 of a texel, so that a renderer that
    /// rounds down never reads beyond.
    const std::vector<glm::vec3>& texels() const { return texels_; }
    /// Rows of the image; 0 without tiles.
    std::size_t height() const { return height_; }
    std::size_t tiles() const { return tiles_; }
    /// The spacing asked for, or the larger one that max_texels allows, mm.
    double spacing_mm() const { return spacing_mm_; }

  private:
    std::vector<glm::vec3> texels_;
    std::size_t height_ = 0;
    std::size_t tiles_ = 0;
    double spacing_mm_ = 0;
};

/// The points of a surface that the texels of its tiles stand for. The surface may be another than the one that
/// the tiles were laid out for: posed, subdivided, cut into triangles, each with the texel coordinates that
/// a renderer interpolates over it.
///
/// Every texel that may be read for a point of a tile has a target. Where no triangle covers it, it is the point that
/// continues the nearest triangle, so that interpolation is linear up to the edge. Texels at one point of the
/// surface, on edges and corners that faces share, have one target.
class TileTargets {
  public:
    /// @param mesh     as it is shown; triangles without texels may be among it
    /// @param texels   three per triangle: FaceTiles::texels() at its corners
    /// @param height   rows of the image
    /// @param unit_mm  length of one unit of the vertices, mm; finite, above 0
    /// @throws std::invalid_argument naming what is not allowed
    TileTargets(const MeshView& mesh, std::span<const glm::vec3> texels, std::size_t height,
                double unit_mm = 1.0);

    const std::vector<glm::dvec3>& points() const { return points_; }
    /// Unit vectors, interpolated between those of the vertices; 0 where there is none.
    const std::vector<glm::dvec3>& normals() const { return normals_; }
    /// For each texel its target, rows of tile_image_width one after another; -1: none.
    const std::vector<std::int32_t>& of_texel() const { return of_texel_; }
    /// Fraction of the area of tiles in which a texel stands for two places of the surface, as where it is mirrored.
    double overlapping() const { return overlapping_; }
    /// Fraction of the area of tiles whose triangles reach from one tile into another, or out of all.
    double mixed() const { return mixed_; }
    /// Distance of texels on the surface: root of its area for each texel, mm; 0 without tiles.
    double spacing_mm() const { return spacing_mm_; }

    /// Values at the targets from values at the vertices, linear on each triangle. Those that are 0 or more at
    /// a triangle's corners stay so.
    /// @param values   finite, `columns` per vertex
    std::vector<double> at_vertices(std::span<const double> values, std::size_t columns) const;

    /// Pixels of the image from values at the targets.
    /// @param values    finite, `columns` per target, at most the largest float
    /// @param channels  of the image, at least `columns`: those beyond are left as they are
    /// @param pixels    height * tile_image_width * channels; 0 is written where there is no target
    void spread(std::span<const double> values, std::size_t columns, std::size_t channels,
                std::span<float> pixels) const;

  private:
    std::vector<glm::dvec3> points_;
    std::vector<glm::dvec3> normals_;
    std::vector<glm::uvec3> corners_;  ///< of the triangle that each target lies in
    std::vector<glm::dvec3> weights_;  ///< of those corners
    std::vector<std::int32_t> of_texel_;
    std::size_t vertices_ = 0;
    double overlapping_ = 0;
    double mixed_ = 0;
    double spacing_mm_ = 0;
};

}  // namespace skinglow
