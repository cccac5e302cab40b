#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "shape/flesh_surface.h"

namespace skinglow::detail {

/// Cells of flesh, cubes whose center is inside, within a margin of some points.
class VoxelGrid {
  public:
    static constexpr std::int32_t outside = -1;   ///< the center is not in flesh
    static constexpr std::int32_t left_out = -2;  ///< flesh beyond the margin
    static constexpr std::int32_t unknown = -3;   ///< far beyond it: nobody has asked
    static constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();

    struct Neighbors {
        /// Across -x, +x, -y, +y, -z, +z; size() where there is no cell.
        std::array<std::uint32_t, 6> cell;
        std::uint8_t cuts = 0;  ///< number of faces behind which flesh was left out
    };

    /// @param centers  points about which flesh matters, mm
    /// @param margin   mm
    /// @param cell     edge, mm, above 0
    /// @param threads  0: one for each processor
    VoxelGrid(const FleshSurface& surface, std::span<const glm::vec3> centers, double margin, double cell,
              int threads);

    std::uint32_t size() const { return static_cast<std::uint32_t>(neighbors_.size()); }
    float cell() const { return cell_; }
    const Neighbors& neighbors(std::uint32_t cell) const { return neighbors_[cell]; }

    /// The voxel of the cell that holds a point.
    glm::ivec3 voxel_of(const glm::vec3& point) const {
        // Without a call of the library's floor, which is one where processors may be old.
        const glm::vec3 at = (point - low_) / cell_;
        const glm::ivec3 cut(at);
        return {cut.x - (at.x < static_cast<float>(cut.x) ? 1 : 0),
                cut.y - (at.y < static_cast<float>(cut.y) ? 1 : 0),
                cut.z - (at.z < static_cast<float>(cut.z) ? 1 : 0)};
    }
    bool has(const glm::ivec3& voxel) const {
        return voxel.x >= 0 && voxel.y >= 0 && voxel.z >= 0 && voxel.x < extent_.x && voxel.y < extent_.y &&
               voxel.z < extent_.z;
    }
    /// How far a ray goes until no cell is about it any more; all in cells, `start` from the center of the first.
    float leaving(const glm::vec3& start, const glm::vec3& direction) const;
    /// Number of the cell at a voxel, or one of the constants above.
    std::int32_t at(const glm::ivec3& voxel) const { return has(voxel) ? index_[linear(voxel)] : unknown; }
    glm::vec3 center_of(const glm::ivec3& voxel) const { return low_ + (glm::vec3(voxel) + 0.5F) * cell_; }
    const glm::vec3& low() const { return low_; }
    const glm::ivec3& extent() const { return extent_; }
    std::size_t voxels() const {
        return static_cast<std::size_t>(extent_.x) * static_cast<std::size_t>(extent_.y) *
               static_cast<std::size_t>(extent_.z);
    }
    std::size_t linear(const glm::ivec3& p) const {
        return (static_cast<std::size_t>(p.x) * static_cast<std::size_t>(extent_.y) +
                static_cast<std::size_t>(p.y)) *
                   static_cast<std::size_t>(extent_.z) +
               static_cast<std::size_t>(p.z);
    }
    const std::vector<std::int32_t>& index() const { return index_; }
    std::size_t bytes() const {
        return index_.size() * sizeof(std::int32_t) + neighbors_.size() * sizeof(Neighbors);
    }

  private:
    void fit(std::span<const glm::vec3> centers, double margin);
    std::vector<std::uint8_t> mark_near(std::span<const glm::vec3> centers, double margin) const;
    void number_cells();

    float cell_;
    glm::vec3 low_{0.0F};
    glm::ivec3 extent_{0};
    std::vector<std::int32_t> index_;
    std::vector<Neighbors> neighbors_;
};

/// Number of voxels of the box that a grid would have: what it costs at least.
double box_voxels(std::span<const glm::vec3> centers, double margin, double cell);

}  // namespace skinglow::detail
