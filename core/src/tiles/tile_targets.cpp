#include <skinglow/face_tiles.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "tiles/surface_texels.h"
#include "tiles/target_builder.h"
#include "tiles/texel_triangle.h"
#include "tiles/unit_box.h"

namespace skinglow {
namespace {

constexpr std::size_t max_height = 65536;

void check_values(std::span<const double> values, std::size_t rows, std::size_t columns, const char* per,
                  double largest) {
    require("columns", columns, columns > 0, "1 or more");
    require_count("values", values.size(), rows * columns, per);
    for (std::size_t i = 0; i < values.size(); ++i) {
        require(entry_name("values", i / columns), values[i], std::abs(values[i]) <= largest,
                "finite numbers");
    }
}

}  // namespace

TileTargets::TileTargets(const MeshView& mesh, std::span<const glm::vec3> texels, std::size_t height,
                         double unit_mm)
    : vertices_(mesh.vertices().size()) {
    require_positive("unit_mm", unit_mm);
    require("height", height, height <= max_height, "at most " + std::to_string(max_height));
    const UnitBox to_unit(box_of({&mesh, 1}).value_or(Box{}));
    const SurfaceTexels surface = surface_texels(mesh, to_unit, texels, height);
    if (surface.area > 0) mixed_ = surface.mixed_area / surface.area;
    if (surface.held_area > 0) overlapping_ = surface.overlapping_area / surface.held_area;
    const double texel_size =
        surface.texel_area > 0 ? std::sqrt((surface.area - surface.mixed_area) / surface.texel_area) : 0.0;
    spacing_mm_ = std::min(texel_size * to_unit.scale() * unit_mm, std::numeric_limits<double>::max());
    const auto& triangles = surface.triangle;
    const auto used = triangles.size() - static_cast<std::size_t>(std::count(
                                             triangles.begin(), triangles.end(), SurfaceTexels::none));
    TargetBuilder builder(mesh, to_unit, used, texel_size);
    of_texel_.assign(triangles.size(), -1);
    std::uint32_t last = SurfaceTexels::none;
    TexelTriangle triangle;
    for (std::size_t at = 0; at < triangles.size(); ++at) {
        if (triangles[at] == SurfaceTexels::none) continue;
        if (triangles[at] != last)
            triangle = TexelTriangle(texels.subspan(3 * std::size_t{triangles[at]}).first<3>());
        last = triangles[at];
        const glm::dvec2 texel(at % tile_image_width, at / tile_image_width);
        const glm::uvec3& corners = mesh.triangles()[last];
        of_texel_[at] = surface.distance[at] == 0 ? builder.within(corners, triangle, texel)
                                                  : builder.beyond(corners, triangle, texel);
    }
    detail::SurfacePoints targets = std::move(builder).targets();
    points_ = std::move(targets.points);
    normals_ = std::move(targets.normals);
    corners_ = std::move(targets.corners);
    weights_ = std::move(targets.weights);
}

std::vector<double> TileTargets::at_vertices(std::span<const double> values, std::size_t columns) const {
    check_values(values, vertices_, columns, "one per vertex and column", std::numeric_limits<double>::max());
    std::vector<double> result(points_.size() * columns);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const glm::uvec3& c = corners_[i];
        const glm::dvec3& w = weights_[i];
        for (std::size_t k = 0; k < columns; ++k) {
            const double x = values[c.x * columns + k];
            const double y = values[c.y * columns + k];
            const double z = values[c.z * columns + k];
            const double value = w.x * x + w.y * y + w.z * z;
            result[i * columns + k] = std::min({x, y, z}) >= 0 ? std::max(value, 0.0) : value;
        }
    }
    return result;
}

void TileTargets::spread(std::span<const double> values, std::size_t columns, std::size_t channels,
                         std::span<float> pixels) const {
    check_values(values, points_.size(), columns, "one per target and column",
                 std::numeric_limits<float>::max());
    require("channels", channels, channels >= columns, "at least the columns of the values");
    require_count("pixels", pixels.size(), of_texel_.size() * channels, "one per channel of each texel");
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t at = begin; at < end; ++at) {
            float* pixel = pixels.data() + at * channels;
            if (of_texel_[at] < 0) {
                std::fill(pixel, pixel + columns, 0.0F);
                continue;
            }
            const double* value = values.data() + static_cast<std::size_t>(of_texel_[at]) * columns;
            for (std::size_t k = 0; k < columns; ++k) pixel[k] = static_cast<float>(value[k]);
        }
    };
    constexpr std::size_t block = std::size_t{1} << 15U;
    for_each_block(of_texel_.size(), 0, work, {}, block);
}

}  // namespace skinglow
