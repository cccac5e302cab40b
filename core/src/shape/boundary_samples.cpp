#include "shape/boundary_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "numerics/job.h"
#include "shape/flesh_cells.h"

namespace skinglow::detail {
namespace {

/// How far a cell's center may lie before a piece's plane, in cells.
constexpr float max_before = 0.3F;

/// Gives one piece to its cell.
/// @return false where there is flesh about it and no cell
bool assign(const VoxelGrid& grid, const glm::vec3& point, const glm::vec3& normal, BoundarySample& sample) {
    const glm::vec3 below = point - normal * (0.5F * grid.cell());
    const glm::ivec3 middle = grid.voxel_of(below);
    float best = std::numeric_limits<float>::infinity();
    bool has_flesh_left_out = false;
    sample.cell = VoxelGrid::no_cell;
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            for (int k = -1; k <= 1; ++k) {
                const glm::ivec3 voxel = middle + glm::ivec3(i, j, k);
                const std::int32_t cell = grid.at(voxel);
                if (cell == VoxelGrid::left_out || cell == VoxelGrid::unknown) has_flesh_left_out = true;
                if (cell < 0) continue;
                const glm::vec3 center = grid.center_of(voxel);
                const float height = glm::dot(point - center, normal);
                const glm::vec3 off = center - below;
                const float distance_sq = glm::dot(off, off);
                if (height < -max_before * grid.cell() || distance_sq >= best) continue;
                best = distance_sq;
                sample.cell = static_cast<std::uint32_t>(cell);
                sample.height = std::max(0.0F, height);
            }
        }
    }
    return sample.cell != VoxelGrid::no_cell || has_flesh_left_out;
}

}  // namespace

BoundarySamples boundary_samples(const FleshSurface& surface, const VoxelGrid& grid) {
    const Body& body = surface.body();
    BoundarySamples result;
    for (std::uint32_t f = 0; f < body.triangles().size(); ++f) {
        stop_if_asked(f);
        const BodyTriangle& t = body.triangles()[f];
        if (!is_near(body, t, grid) || surface.is_all_wall(f)) continue;
        const int parts = parts_of(body, t, 0.5F * grid.cell());
        const auto scale = static_cast<float>(parts);
        BoundarySample sample{0, f, 0, 0, t.area / (scale * scale), 0, 0};
        for (int i = 0; i < parts; ++i) {
            for (int j = 0; i + j < parts; ++j) {
                for (int half = 0; half < 2; ++half) {
                    if (half == 1 && i + j > parts - 2) continue;
                    const float third = half == 1 ? 2.0F / 3 : 1.0F / 3;
                    sample.u = (static_cast<float>(i) + third) / scale;
                    sample.v = (static_cast<float>(j) + third) / scale;
                    const glm::vec3 point = body.at(t, sample.u, sample.v);
                    sample.curvature = body.curvature()[t.welded.x] * (1 - sample.u - sample.v) +
                                       body.curvature()[t.welded.y] * sample.u +
                                       body.curvature()[t.welded.z] * sample.v;
                    if (grid.at(grid.voxel_of(point)) == VoxelGrid::unknown) continue;
                    if (surface.is_wall(f, sample.u, sample.v)) continue;
                    if (!assign(grid, point, t.normal, sample))
                        result.lost_area += static_cast<double>(sample.area);
                    if (sample.cell == VoxelGrid::no_cell) continue;
                    result.area += static_cast<double>(sample.area);
                    result.samples.push_back(sample);
                }
            }
        }
    }
    return result;
}

}  // namespace skinglow::detail
