#include "shape/flesh_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "numerics/job.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

constexpr int edge = 3;  ///< of a block, in cells
constexpr int block_cells = edge * edge * edge;
static_assert(block_cells <= PointCluster::capacity);
/// Length of a triangle's parts, and how far from their middle cells count as touched, in cells: what a line
/// between two neighboring centers crosses is found in one of their cells.
constexpr float part_cells = 0.3F;
constexpr float touch_cells = 0.25F;
/// A winding number this far from 1/2 is that of all cells it stands for.
constexpr float certain = 0.25F;
constexpr int max_triangle_parts = 400;

void touch(const VoxelGrid& grid, const glm::vec3& point, std::vector<std::uint8_t>& touched) {
    const glm::vec3 around(touch_cells * grid.cell());
    const glm::ivec3 low = glm::max(grid.voxel_of(point - around), glm::ivec3(0));
    const glm::ivec3 high = glm::min(grid.voxel_of(point + around), grid.extent() - 1);
    for (int x = low.x; x <= high.x; ++x) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int z = low.z; z <= high.z; ++z) touched[grid.linear({x, y, z})] = 1;
        }
    }
}

/// Voxels whose cube a triangle comes near.
std::vector<std::uint8_t> touched_voxels(const Body& body, const VoxelGrid& grid) {
    std::vector<std::uint8_t> touched(grid.voxels(), 0);
    for (std::size_t f = 0; f < body.triangles().size(); ++f) {
        stop_if_asked(f);
        const BodyTriangle& t = body.triangles()[f];
        if (!is_near(body, t, grid)) continue;
        const int parts = parts_of(body, t, part_cells * grid.cell());
        const auto scale = static_cast<float>(parts);
        for (int i = 0; i <= parts; ++i) {
            for (int j = 0; i + j <= parts; ++j)
                touch(grid, body.at(t, static_cast<float>(i) / scale, static_cast<float>(j) / scale),
                      touched);
        }
    }
    return touched;
}

/// Answers voxels, block by block.
class FleshAsker {
  public:
    FleshAsker(const FleshSurface& surface, const VoxelGrid& grid, std::span<const std::uint8_t> wanted,
               std::span<const std::uint8_t> touched, std::span<std::uint8_t> flesh)
        : surface_(surface), grid_(grid), wanted_(wanted), touched_(touched), flesh_(flesh) {}

    /// Those of a block; those that follow each other should be neighbors.
    void ask(const glm::ivec3& corner) {
        Block block;
        bool is_any_touched = false;
        for (int c = 0; c < block_cells; ++c) {
            const glm::ivec3 voxel = corner + glm::ivec3(c / (edge * edge), c / edge % edge, c % edge);
            if (!grid_.has(voxel)) continue;
            const std::size_t i = grid_.linear(voxel);
            is_any_touched = is_any_touched || touched_[i] != 0;
            if (wanted_[i] == 0) continue;
            block.voxels[block.count] = i;
            block.centers[block.count++] = grid_.center_of(voxel);
        }
        if (block.count == 0) return;
        if (is_any_touched) {
            answer_each(block);
        } else {
            untouched_.push_back(block);
            if (untouched_.size() == blocks_at_once) answer_untouched();
        }
    }

    /// Blocks that nothing touches: one number is that of a whole block, where it is certain.
    void answer_untouched() {
        if (untouched_.empty()) return;
        std::array<glm::vec3, blocks_at_once> middles{};
        std::array<float, blocks_at_once> winding{};
        for (std::size_t b = 0; b < untouched_.size(); ++b)
            middles[b] = untouched_[b].centers[untouched_[b].count / 2];
        surface_.tree().windings(std::span(middles).first(untouched_.size()), winding);
        for (std::size_t b = 0; b < untouched_.size(); ++b) {
            const Block& block = untouched_[b];
            if (std::abs(winding[b] - 0.5F) > certain) {
                for (std::size_t n = 0; n < block.count; ++n)
                    flesh_[block.voxels[n]] = winding[b] > 0.5F ? 1 : 0;
            } else {
                answer_each(block);
            }
        }
        untouched_.clear();
    }

  private:
    static constexpr std::size_t blocks_at_once = 8;

    /// What of a block is wanted.
    struct Block {
        std::size_t count = 0;
        std::array<std::size_t, block_cells> voxels;
        std::array<glm::vec3, block_cells> centers;
    };

    void answer_each(const Block& block) {
        std::array<float, block_cells> winding{};
        surface_.tree().windings(std::span(block.centers).first(block.count), winding);
        for (std::size_t n = 0; n < block.count; ++n) flesh_[block.voxels[n]] = winding[n] > 0.5F ? 1 : 0;
    }

    const FleshSurface& surface_;
    const VoxelGrid& grid_;
    std::span<const std::uint8_t> wanted_;
    std::span<const std::uint8_t> touched_;
    std::span<std::uint8_t> flesh_;
    std::vector<Block> untouched_;
};

}  // namespace

bool is_near(const Body& body, const BodyTriangle& t, const VoxelGrid& grid) {
    const glm::vec3 a = body.corner(t, 0);
    const glm::vec3 b = body.corner(t, 1);
    const glm::vec3 c = body.corner(t, 2);
    const glm::vec3 high = glm::max(glm::max(a, b), c) - grid.low();
    const glm::vec3 low = glm::min(glm::min(a, b), c) - grid.low();
    const glm::vec3 end = glm::vec3(grid.extent()) * grid.cell();
    for (int k = 0; k < 3; ++k) {
        if (high[k] < 0 || low[k] > end[k]) return false;
    }
    return true;
}

int parts_of(const Body& body, const BodyTriangle& t, float length) {
    float longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(longest, glm::length(body.corner(t, k) - body.corner(t, (k + 1) % 3)));
    return static_cast<int>(
        std::clamp(std::ceil(longest / length), 1.0F, static_cast<float>(max_triangle_parts)));
}

std::vector<std::uint8_t> find_flesh(const FleshSurface& surface, const VoxelGrid& grid,
                                     std::span<const std::uint8_t> wanted, int threads) {
    const std::vector<std::uint8_t> touched = touched_voxels(surface.body(), grid);
    std::vector<std::uint8_t> flesh(grid.voxels(), 0);
    const glm::ivec3 blocks = (grid.extent() + edge - 1) / edge;
    const auto count = static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks.y);
    const auto work = [&](std::size_t begin, std::size_t end) {
        FleshAsker asker(surface, grid, wanted, touched, flesh);
        for (std::size_t b = begin; b < end; ++b) {
            const glm::ivec3 first(static_cast<int>(b) / blocks.y, static_cast<int>(b) % blocks.y, 0);
            for (int z = 0; z < blocks.z; ++z) asker.ask((first + glm::ivec3(0, 0, z)) * edge);
            asker.answer_untouched();
        }
    };
    for_each_block(count, threads, work, {}, 8);
    return flesh;
}

}  // namespace skinglow::detail
