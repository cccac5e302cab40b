#include "tiles/tile_layout.h"

#include <skinglow/face_tiles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "geometry/edge_twins.h"
#include "tiles/plane_chart.h"

namespace skinglow::detail {
namespace {

constexpr std::uint32_t max_cells = tile_image_width - 1;
/// Faces share the tiles of a plane where they have so small an area for each of their vertices, in squares of the
/// spacing, that a plane takes no more points than there are vertices; and where no edge is longer, in spacings.
constexpr double dense_area = 0.36;
constexpr double dense_edge = 1.25;
/// Of such a tile, in spacings.
constexpr double max_chart_extent = 12;
/// Texels of a plane are nearer to each other: no edge is a line of them, and faces are tilted against it.
constexpr double plane_spacing = 0.8;
/// Two triangles that are bent more (60 degrees) do not share a tile.
constexpr double min_pair_cosine = 0.5;
/// A plane is taken where it has this many times fewer texels than the face's own grid.
constexpr std::uint64_t plane_saving = 2;

std::uint32_t cells(double count) {
    return static_cast<std::uint32_t>(std::clamp(count, 1.0, static_cast<double>(max_cells)));
}

/// Of an edge.
std::uint32_t cells(double length, double spacing) {
    // To the nearest, not up: the edges of scans are about as long as the spacing, and most would be cut in two.
    return cells(std::round(length / spacing));
}

std::uint64_t texels(const glm::uvec2& size) {
    return (std::uint64_t{size.x} + 1) * (size.y + 1);
}

glm::uvec2 chart_size(const PlaneChart& chart, double spacing) {
    const glm::dvec2 size = glm::ceil(chart.extent() / (plane_spacing * spacing) - 1e-6);  // but for rounding
    return {cells(size.x), cells(size.y)};
}

class Builder {
  public:
    Builder(const FaceList& faces, std::span<const std::uint32_t> twins, std::span<const std::uint8_t> wanted,
            double spacing)
        : faces_(faces), twins_(twins), spacing_(spacing), available_(wanted.begin(), wanted.end()) {
        layout_.tile_of_face.assign(faces.faces(), no_tile);
        layout_.in_tile.assign(faces.corners().size(), glm::dvec2(0.0));
        face_of_corner_.resize(faces.corners().size());
        for (std::uint32_t face = 0; face < faces.faces(); ++face) {
            std::fill(face_of_corner_.begin() + faces.begin()[face],
                      face_of_corner_.begin() + faces.begin()[face + 1], face);
        }
    }

    TileLayout build() {
        share_planes();
        pair_triangles(true);
        pair_triangles(false);
        for (std::uint32_t face = 0; face < faces_.faces(); ++face) {
            if (available_[face] != 0) add_single(face);
        }
        return std::move(layout_);
    }

  private:
    /// Dense faces, in groups; not where faces of their own take fewer texels.
    void share_planes() {
        std::vector<std::uint8_t> dense(faces_.faces());
        for (std::uint32_t face = 0; face < faces_.faces(); ++face)
            dense[face] = available_[face] != 0 && is_dense(face) ? 1 : 0;
        for (std::uint32_t face = 0; face < faces_.faces(); ++face) {
            if (dense[face] == 0) continue;
            PlaneChart chart(faces_, face);
            const std::vector<std::uint32_t> group =
                faces_about(faces_, twins_, face_of_corner_, face, max_chart_extent * spacing_, dense, chart);
            std::uint64_t alone = 0;
            for (const std::uint32_t each : group) alone += 2 * (faces_.size(each) - 2);  // halves of 2 x 2
            if (texels(chart_size(chart, spacing_)) <= alone) add_plane(group, chart);
        }
    }

    bool is_dense(std::uint32_t face) const {
        // In a closed mesh of triangles a vertex has two of them, in one of quads one.
        const double per_vertex = 2 * faces_.area(face) / (faces_.size(face) - 2);
        return faces_.longest_edge(face) < dense_edge * spacing_ &&
               per_vertex < dense_area * spacing_ * spacing_;
    }

    /// Pairs of triangles, over the edge that is the longest of both or, after that, of one.
    void pair_triangles(bool of_both) {
        for (std::uint32_t face = 0; face < faces_.faces(); ++face) {
            if (!is_single_triangle(face)) continue;
            const std::uint32_t corner = longest_corner(face);
            const std::uint32_t twin = twins_[corner];
            if (twin == no_twin) continue;
            const std::uint32_t other = face_of_corner_[twin];
            if (other == face || !is_single_triangle(other)) continue;
            if (of_both && longest_corner(other) != twin) continue;
            if (glm::dot(faces_.normal(face), faces_.normal(other)) < min_pair_cosine) continue;
            // Faces that face alike run along their edge in opposite directions, but for a twisted strip.
            if (faces_.corners()[corner] == faces_.corners()[twin]) continue;
            add_pair(face, corner - faces_.begin()[face], other, twin - faces_.begin()[other]);
        }
    }

    bool is_single_triangle(std::uint32_t face) const {
        return available_[face] != 0 && faces_.size(face) == 3;
    }

    std::uint32_t longest_corner(std::uint32_t face) const {
        std::array<double, 3> lengths{};
        for (std::uint32_t k = 0; k < 3; ++k) lengths[k] = glm::length(faces_.edge(face, k));
        return faces_.begin()[face] +
               static_cast<std::uint32_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
    }

    /// Two triangles with a common edge, which begins at corner `at` of one and `twin` of the other, as the halves of a
    /// square.
    void add_pair(std::uint32_t face, std::uint32_t at, std::uint32_t other, std::uint32_t twin) {
        const auto length = [&](std::uint32_t f, std::uint32_t k) {
            return glm::length(faces_.edge(f, k % 3));
        };
        const std::uint32_t begin = faces_.begin()[face];
        const std::uint32_t far = faces_.begin()[other];
        const glm::uvec2 size(cells(std::max(length(face, at + 1), length(other, twin + 1)), spacing_),
                              cells(std::max(length(face, at + 2), length(other, twin + 2)), spacing_));
        PlaneChart chart(faces_, face);
        chart.add(faces_, other, std::numeric_limits<double>::infinity());
        if (texels(chart_size(chart, spacing_)) * plane_saving < texels(size)) {
            add_plane(std::array{face, other}, chart);
            return;
        }
        begin_tile(size);
        const glm::dvec2 full(size);
        place(begin + at, {0.0, full.y});
        place(begin + (at + 1) % 3, {full.x, 0.0});
        place(begin + (at + 2) % 3, {0.0, 0.0});
        place(far + twin, {full.x, 0.0});
        place(far + (twin + 1) % 3, {0.0, full.y});
        place(far + (twin + 2) % 3, full);
        assign(face);
        assign(other);
    }

    void add_single(std::uint32_t face) {
        const std::uint32_t sides = faces_.size(face);
        const std::uint32_t begin = faces_.begin()[face];
        const auto length = [&](std::uint32_t k) { return glm::length(faces_.edge(face, k)); };
        // A triangle's longest edge is the diagonal of its tile.
        const std::uint32_t apex = sides == 3 ? (longest_corner(face) - begin + 2) % 3 : 0;
        glm::uvec2 size(1);
        if (sides == 3) {
            size = {cells(length(apex), spacing_), cells(length((apex + 2) % 3), spacing_)};
        } else if (sides == 4) {
            size = {cells(std::max(length(0), length(2)), spacing_),
                    cells(std::max(length(1), length(3)), spacing_)};
        }
        const PlaneChart chart(faces_, face);
        if (sides > 4 || texels(chart_size(chart, spacing_)) * plane_saving < texels(size)) {
            add_plane(std::array{face}, chart);
            return;
        }
        begin_tile(size);
        const glm::dvec2 full(size);
        place(begin + apex, {0.0, 0.0});
        place(begin + (apex + 1) % sides, {full.x, 0.0});
        place(begin + (apex + 2) % sides, sides == 4 ? full : glm::dvec2(0.0, full.y));
        if (sides == 4) place(begin + 3, {0.0, full.y});
        assign(face);
    }

    void add_plane(std::span<const std::uint32_t> group, const PlaneChart& chart) {
        begin_tile(chart_size(chart, spacing_));
        const glm::dvec2 extent = chart.extent();
        const double largest = std::max(extent.x, extent.y);
        // A plane longer than an image is wide has its texels farther apart.
        const double scale =
            std::min(1 / (plane_spacing * spacing_), largest > 0 ? max_cells / largest : 1.0);
        for (const std::uint32_t face : group) {
            for (std::uint32_t c = faces_.begin()[face]; c < faces_.begin()[face + 1]; ++c)
                place(c, (chart.project(faces_.point(c)) - chart.min()) * scale);
            assign(face);
        }
    }

    /// Tiles lie on their longer side: shelves of one height hold more of them.
    void begin_tile(const glm::uvec2& size) {
        flipped_ = size.y > size.x;
        layout_.sizes.push_back(flipped_ ? glm::uvec2(size.y, size.x) : size);
    }
    void assign(std::uint32_t face) {
        layout_.tile_of_face[face] = static_cast<std::uint32_t>(layout_.sizes.size() - 1);
        available_[face] = 0;
    }
    void place(std::uint32_t corner, const glm::dvec2& where) {
        layout_.in_tile[corner] = flipped_ ? glm::dvec2(where.y, where.x) : where;
    }

    const FaceList& faces_;
    std::span<const std::uint32_t> twins_;
    double spacing_;
    std::vector<std::uint8_t> available_;  ///< wanted, and without a tile so far
    std::vector<std::uint32_t> face_of_corner_;
    TileLayout layout_;
    bool flipped_ = false;  ///< of the last tile
};

}  // namespace

TileLayout tile_layout(const FaceList& faces, std::span<const std::uint32_t> twins,
                       std::span<const std::uint8_t> wanted, double spacing) {
    return Builder(faces, twins, wanted, spacing).build();
}

PackedTiles pack(std::span<const glm::uvec2> sizes) {
    std::vector<std::uint32_t> order(sizes.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return sizes[a].y > sizes[b].y; });
    PackedTiles result;
    result.corner.resize(sizes.size());
    std::size_t x = tile_image_width;  // no shelf yet
    std::size_t y = 0;
    for (const std::uint32_t tile : order) {
        const std::size_t width = std::size_t{sizes[tile].x} + 1;
        if (x + width > tile_image_width) {
            y = result.height;
            x = 0;
            result.height += std::size_t{sizes[tile].y} + 1;
        }
        result.corner[tile] = {x, y};
        x += width;
    }
    return result;
}

}  // namespace skinglow::detail
