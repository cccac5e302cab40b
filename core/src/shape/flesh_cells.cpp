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
/// Length of a triangle's parts, and how far from their middle cells count as touched, in cells: what a line
/// between two neighboring centers crosses is found in one of their cells.
constexpr float part_cells = 0.3F;
constexpr float touch_cells = 0.25F;
/// A winding number this far from 1/2 is that of all cells it stands for.
constexpr double certain = 0.25;
constexpr int max_parts = 400;

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

/// Answers the voxels of one block.
class BlockAsker {
  public:
    BlockAsker(const FleshSurface& surface, const VoxelGrid& grid, std::span<const std::uint8_t> wanted,
               std::span<const std::uint8_t> touched, std::span<std::uint8_t> flesh)
        : surface_(surface), grid_(grid), wanted_(wanted), touched_(touched), flesh_(flesh) {}

    void ask(const glm::ivec3& corner) {
        corner_ = corner;
        bool any = false;
        for (int c = 0; c < block_cells; ++c) {
            const glm::ivec3 voxel = voxel_of(c);
            const bool has = grid_.has(voxel);
            const std::size_t i = has ? grid_.linear(voxel) : 0;
            any = any || (has && wanted_[i] != 0);
            open_[static_cast<std::size_t>(c)] = has && touched_[i] == 0;
            done_[static_cast<std::size_t>(c)] = !has;
        }
        if (!any) return;
        for (int c = 0; c < block_cells; ++c) {
            if (done_[static_cast<std::size_t>(c)]) continue;
            if (open_[static_cast<std::size_t>(c)]) {
                answer_alike(c);
            } else {
                answer(c, winding(c) > 0.5);
            }
        }
    }

  private:
    glm::ivec3 voxel_of(int c) const {
        return corner_ + glm::ivec3(c / (edge * edge), c / edge % edge, c % edge);
    }
    double winding(int c) const { return surface_.tree().winding(grid_.center_of(voxel_of(c))); }
    void answer(int c, bool is_flesh) {
        done_[static_cast<std::size_t>(c)] = true;
        const std::size_t i = grid_.linear(voxel_of(c));
        if (wanted_[i] != 0) flesh_[i] = is_flesh ? 1 : 0;
    }

    /// A cell that nothing touches, and those that hang together with it.
    void answer_alike(int first) {
        alike_.assign(1, first);
        done_[static_cast<std::size_t>(first)] = true;
        for (std::size_t next = 0; next < alike_.size(); ++next) {
            const int c = alike_[next];
            const std::array<int, 3> at = {c / (edge * edge), c / edge % edge, c % edge};
            const std::array<int, 3> stride = {edge * edge, edge, 1};
            for (std::size_t d = 0; d < 3; ++d) {
                for (const int sign : {-1, 1}) {
                    if (at[d] + sign < 0 || at[d] + sign >= edge) continue;
                    const auto other = static_cast<std::size_t>(c + sign * stride[d]);
                    if (!open_[other] || done_[other]) continue;
                    done_[other] = true;
                    alike_.push_back(static_cast<int>(other));
                }
            }
        }
        const double middle = winding(alike_[alike_.size() / 2]);
        const bool is_certain = std::abs(middle - 0.5) > certain;
        for (const int c : alike_) answer(c, (is_certain ? middle : winding(c)) > 0.5);
    }

    const FleshSurface& surface_;
    const VoxelGrid& grid_;
    std::span<const std::uint8_t> wanted_;
    std::span<const std::uint8_t> touched_;
    std::span<std::uint8_t> flesh_;
    glm::ivec3 corner_{0};
    std::array<bool, block_cells> open_{};
    std::array<bool, block_cells> done_{};
    std::vector<int> alike_;
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
    return static_cast<int>(std::clamp(std::ceil(longest / length), 1.0F, static_cast<float>(max_parts)));
}

std::vector<std::uint8_t> find_flesh(const FleshSurface& surface, const VoxelGrid& grid,
                                     std::span<const std::uint8_t> wanted, int threads) {
    const std::vector<std::uint8_t> touched = touched_voxels(surface.body(), grid);
    std::vector<std::uint8_t> flesh(grid.voxels(), 0);
    const glm::ivec3 blocks = (grid.extent() + edge - 1) / edge;
    const auto count = static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks.y);
    const auto work = [&](std::size_t begin, std::size_t end) {
        BlockAsker asker(surface, grid, wanted, touched, flesh);
        for (std::size_t b = begin; b < end; ++b) {
            for (int z = 0; z < blocks.z; ++z)
                asker.ask(glm::ivec3(static_cast<int>(b) / blocks.y, static_cast<int>(b) % blocks.y, z) *
                          edge);
        }
    };
    for_each_block(count, threads, work, {}, 8);
    return flesh;
}

}  // namespace skinglow::detail
