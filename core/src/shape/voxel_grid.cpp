#include "shape/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "numerics/job.h"
#include "shape/flesh_cells.h"

namespace skinglow::detail {
namespace {

constexpr std::uint8_t near_margin = 1;  ///< within the margin
constexpr std::uint8_t near_rim = 2;     ///< within two cells of it: asked whether it is flesh, no more
constexpr double rim_cells = 2.0;

struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{-std::numeric_limits<float>::max()};
};

Bounds bounds_of(std::span<const glm::vec3> points) {
    Bounds bounds;
    for (const glm::vec3& p : points) {
        bounds.low = glm::min(bounds.low, p);
        bounds.high = glm::max(bounds.high, p);
    }
    return bounds;
}

/// The cells of a ball as runs along z.
struct Run {
    int x, y, half;
};

std::vector<Run> ball_runs(double radius_in_cells) {
    std::vector<Run> runs;
    const int steps = static_cast<int>(std::ceil(radius_in_cells));
    for (int x = -steps; x <= steps; ++x) {
        for (int y = -steps; y <= steps; ++y) {
            const double left = radius_in_cells * radius_in_cells - x * x - y * y;
            if (left >= 0) runs.push_back({x, y, static_cast<int>(std::sqrt(left))});
        }
    }
    return runs;
}

}  // namespace

double box_voxels(std::span<const glm::vec3> centers, double margin, double cell) {
    const Bounds bounds = bounds_of(centers);
    double voxels = 1;
    for (int k = 0; k < 3; ++k)
        voxels *=
            (static_cast<double>(bounds.high[k] - bounds.low[k]) + 2 * margin) / cell + 2 * rim_cells + 3;
    return voxels;
}

VoxelGrid::VoxelGrid(const FleshSurface& surface, std::span<const glm::vec3> centers, double margin,
                     double cell, int threads)
    : cell_(static_cast<float>(cell)) {
    fit(centers, margin);
    const std::vector<std::uint8_t> near = mark_near(centers, margin);
    const std::vector<std::uint8_t> flesh = find_flesh(surface, *this, near, threads);
    index_.assign(near.size(), unknown);
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (near[i] != 0) index_[i] = flesh[i] == 0 ? outside : (near[i] == near_margin ? 0 : left_out);
    }
    number_cells();
}

void VoxelGrid::fit(std::span<const glm::vec3> centers, double margin) {
    const Bounds bounds = bounds_of(centers);
    const auto around = static_cast<float>(margin + (rim_cells + 1) * static_cast<double>(cell_));
    // Cells of all parts are cut from one lattice, so that no seam is seen between them. Its shift is none
    // that flat surfaces have: a center on a surface is neither in nor out.
    constexpr double shift = 0.382;
    const auto cell = static_cast<double>(cell_);
    low_ = (glm::floor(glm::dvec3(bounds.low - around) / cell - shift) + shift) * cell;
    extent_ = glm::ivec3(glm::ceil((bounds.high + around - low_) / cell_)) + 1;
}

std::vector<std::uint8_t> VoxelGrid::mark_near(std::span<const glm::vec3> centers, double margin) const {
    std::vector<std::uint8_t> near(voxels(), 0);
    std::vector<std::uint64_t> voxels;
    voxels.reserve(centers.size());
    for (const glm::vec3& p : centers) voxels.push_back(linear(voxel_of(p)));
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
    const double radius = margin / static_cast<double>(cell_);
    const auto mark = [&](const std::vector<Run>& runs, std::uint8_t value) {
        for (const std::uint64_t voxel : voxels) {
            stop_if_asked();
            const auto z = static_cast<int>(voxel % static_cast<std::uint64_t>(extent_.z));
            const auto row = static_cast<int>(voxel / static_cast<std::uint64_t>(extent_.z));
            for (const Run& run : runs) {
                const glm::ivec3 first(row / extent_.y + run.x, row % extent_.y + run.y, z - run.half);
                if (!has({first.x, first.y, 0})) continue;
                const int begin = std::max(0, first.z);
                const int end = std::min(extent_.z, z + run.half + 1);
                for (int k = begin; k < end; ++k) near[linear({first.x, first.y, k})] = value;
            }
        }
    };
    mark(ball_runs(radius + rim_cells), near_rim);
    mark(ball_runs(radius), near_margin);
    return near;
}

void VoxelGrid::number_cells() {
    // By diagonal planes, x + y + z: cells of one are no neighbors, so that a processor can work on several of them
    // at once in a sweep that goes from cell to neighboring cell.
    const auto z_extent = static_cast<std::uint64_t>(extent_.z);
    const auto y_extent = static_cast<std::uint64_t>(extent_.y);
    const auto plane_of = [&](std::size_t i) {
        const std::uint64_t row = i / z_extent;
        return row / y_extent + row % y_extent + i % z_extent;
    };
    std::vector<std::size_t> begin(static_cast<std::size_t>(extent_.x + extent_.y + extent_.z), 0);
    for (std::size_t i = 0; i < index_.size(); ++i) {
        if (index_[i] >= 0) ++begin[plane_of(i) + 1];
    }
    for (std::size_t p = 1; p < begin.size(); ++p) begin[p] += begin[p - 1];
    std::vector<std::uint64_t> cells(begin.back());
    for (std::size_t i = 0; i < index_.size(); ++i) {
        if (index_[i] < 0) continue;
        const std::size_t number = begin[plane_of(i)]++;
        index_[i] = static_cast<std::int32_t>(number);
        cells[number] = i;
    }
    neighbors_.resize(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        stop_if_asked(c);
        const auto row = static_cast<int>(cells[c] / z_extent);
        const glm::ivec3 voxel(row / extent_.y, row % extent_.y, static_cast<int>(cells[c] % z_extent));
        for (int d = 0; d < 6; ++d) {
            glm::ivec3 next = voxel;
            next[d / 2] += d % 2 == 0 ? -1 : 1;
            const std::int32_t found = at(next);
            neighbors_[c].cell[static_cast<std::size_t>(d)] =
                found >= 0 ? static_cast<std::uint32_t>(found) : static_cast<std::uint32_t>(cells.size());
            if (found == left_out || found == unknown) ++neighbors_[c].cuts;
        }
    }
}

float VoxelGrid::leaving(const glm::vec3& start, const glm::vec3& direction) const {
    float cells = std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k) {
        const float end = direction[k] > 0 ? static_cast<float>(extent_[k]) : -1.0F;
        if (direction[k] != 0) cells = std::min(cells, (end - start[k]) / direction[k]);
    }
    return cells;
}

}  // namespace skinglow::detail
