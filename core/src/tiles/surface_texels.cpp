#include "tiles/surface_texels.h"

#include <skinglow/face_tiles.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>

#include "numerics/argument_check.h"
#include "tiles/texel_triangle.h"

namespace skinglow::detail {
namespace {

/// Tiles are whole numbers but for rounding where a host has interpolated them.
constexpr float whole = 0.01F;

/// The tile that all three corners lie in, 0 for none; -1 where they differ.
std::int64_t tile_of(std::span<const glm::vec3, 3> corners) {
    const float tile = std::round(corners[0].z);
    for (const glm::vec3& corner : corners) {
        if (std::abs(corner.z - tile) > whole) return -1;
    }
    return static_cast<std::int64_t>(tile);
}

void check(std::span<const glm::vec3> texels, std::size_t triangles, std::size_t height) {
    if (texels.size() != 3 * triangles) {
        refuse_argument("texels", std::to_string(texels.size()) + " corners",
                        std::to_string(3 * triangles) + ", three per triangle");
    }
    constexpr auto width = static_cast<float>(tile_image_width);
    constexpr auto max_tile = static_cast<float>(1U << 24U);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const glm::vec3& t = texels[i];
        const bool has_tile = t.z != 0;
        if (t.x >= 0 && t.y >= 0 && t.z >= 0 && t.z <= max_tile &&
            (!has_tile || (t.x <= width - 1 && t.y <= static_cast<float>(height) - 1)))
            continue;
        refuse_argument(entry_name("texels", i)(), to_text(glm::dvec3(t)),
                        "texels of an image of " + std::to_string(tile_image_width) + " x " +
                            std::to_string(height) + ", and a tile");
    }
}

class Rasterizer {
  public:
    Rasterizer(const MeshView& mesh, const UnitBox& to_unit, std::span<const glm::vec3> texels,
               std::size_t height)
        : mesh_(mesh), to_unit_(to_unit), texels_(texels), rows_(height) {
        result_.triangle.assign(height * tile_image_width, SurfaceTexels::none);
        result_.distance.assign(height * tile_image_width, 0.0F);
        areas_.assign(mesh.triangles().size(), -1.0F);
        holds_.assign(mesh.triangles().size(), 0);
    }

    SurfaceTexels run() {
        for (std::uint32_t i = 0; i < areas_.size(); ++i) cover(i);
        for (std::uint32_t i = 0; i < areas_.size(); ++i) {
            if (areas_[i] >= 0) extend(i);
        }
        for (std::size_t i = 0; i < areas_.size(); ++i) {
            if (holds_[i] != 0) result_.held_area += areas_[i];
            if ((holds_[i] & elsewhere) != 0) result_.overlapping_area += areas_[i];
        }
        return std::move(result_);
    }

  private:
    static constexpr std::uint8_t a_texel = 1;
    static constexpr std::uint8_t elsewhere = 2;

    /// Texels that lie in a triangle.
    void cover(std::uint32_t i) {
        const std::int64_t tile = tile_of(corners(i));
        if (tile == 0) return;
        const double area =
            0.5 * glm::length(glm::cross(point(i, 1) - point(i, 0), point(i, 2) - point(i, 0)));
        result_.area += area;
        if (tile < 0) {
            result_.mixed_area += area;
            return;
        }
        areas_[i] = static_cast<float>(area);
        const TexelTriangle triangle(corners(i));
        result_.texel_area += triangle.area();
        for_each_texel(glm::ceil(triangle.low() - on_edge), glm::floor(triangle.high() + on_edge),
                       [&](std::size_t at, const glm::dvec2& texel) {
                           if (triangle.depth(texel) < -on_edge) return;
                           holds_[i] |= a_texel;
                           std::uint32_t& holder = result_.triangle[at];
                           if (holder == SurfaceTexels::none) {
                               holder = i;
                           } else if (is_elsewhere(holder, i, triangle, texel)) {
                               holds_[i] |= elsewhere;
                               holds_[holder] |= elsewhere;
                           }
                       });
    }

    /// Texels that no triangle covers, and that are read for points of this one.
    void extend(std::uint32_t i) {
        const TexelTriangle triangle(corners(i));
        for_each_texel(glm::floor(triangle.low()) - 1.0, glm::floor(triangle.high()) + 2.0,
                       [&](std::size_t at, const glm::dvec2& texel) {
                           const bool is_held = result_.triangle[at] != SurfaceTexels::none;
                           if ((is_held && result_.distance[at] == 0) || !triangle.reads(texel)) return;
                           const auto distance = static_cast<float>(
                               std::max(glm::length(texel - triangle.at(triangle.nearest(texel))), on_edge));
                           if (is_held && !(distance < result_.distance[at])) return;
                           result_.triangle[at] = i;
                           result_.distance[at] = distance;
                       });
    }

    template <typename Use>
    void for_each_texel(const glm::dvec2& low, const glm::dvec2& high, const Use& use) const {
        const glm::dvec2 size(tile_image_width, rows_);
        const glm::uvec2 first(glm::clamp(low, glm::dvec2(0.0), size));
        const glm::uvec2 end(glm::clamp(high + 1.0, glm::dvec2(0.0), size));
        for (std::size_t y = first.y; y < end.y; ++y) {
            for (std::size_t x = first.x; x < end.x; ++x) use(y * tile_image_width + x, glm::dvec2(x, y));
        }
    }

    /// Whether a texel lies in two triangles at positions more than a tenth of a texel apart.
    bool is_elsewhere(std::uint32_t holder, std::uint32_t i, const TexelTriangle& triangle,
                      const glm::dvec2& texel) const {
        const glm::dvec3 between = position(holder, TexelTriangle(corners(holder)).weights(texel)) -
                                   position(i, triangle.weights(texel));
        const double texel_sq = areas_[i] / (triangle.area() > 0 ? triangle.area() : 1.0);
        return glm::dot(between, between) > 0.01 * texel_sq;
    }

    std::span<const glm::vec3, 3> corners(std::size_t triangle) const {
        return texels_.subspan(3 * triangle).first<3>();
    }
    glm::dvec3 point(std::size_t triangle, int k) const {
        return to_unit_(mesh_.vertices()[mesh_.triangles()[triangle][k]]);
    }
    glm::dvec3 position(std::size_t triangle, const glm::dvec3& weights) const {
        return weights.x * point(triangle, 0) + weights.y * point(triangle, 1) +
               weights.z * point(triangle, 2);
    }

    const MeshView& mesh_;
    const UnitBox& to_unit_;
    std::span<const glm::vec3> texels_;
    std::size_t rows_;
    std::vector<float> areas_;         ///< of each triangle; -1: does not lie in one tile
    std::vector<std::uint8_t> holds_;  ///< of each triangle, a_texel and elsewhere
    SurfaceTexels result_;
};

}  // namespace

SurfaceTexels surface_texels(const MeshView& mesh, const UnitBox& to_unit, std::span<const glm::vec3> texels,
                             std::size_t height) {
    check(texels, mesh.triangles().size(), height);
    return Rasterizer(mesh, to_unit, texels, height).run();
}

}  // namespace skinglow::detail
