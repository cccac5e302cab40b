#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A node of a TriangleTree, depth first.
struct TriangleNode {
    glm::vec3 center;          ///< area-weighted
    float radius;              ///< of the ball about it that holds all triangles, mm
    glm::vec3 dipole;          ///< sum of area times normal, over 4 pi
    float far_sq;              ///< squared distance from which the dipole does
    std::uint32_t begin, end;  ///< of its triangles in the tree's order
    std::uint32_t skip;        ///< the node after this one's descendants
    bool is_leaf;
};

/// Points that lie near each other, whose winding numbers are summed side by side.
struct PointCluster {
    static constexpr std::size_t capacity = 32;

    glm::vec3 center{0.0F};  ///< of a ball that holds all of them
    float radius = 0;
    std::size_t count = 0;
    // Those beyond the count are the last one again.
    alignas(64) std::array<float, capacity> x{};
    alignas(64) std::array<float, capacity> y{};
    alignas(64) std::array<float, capacity> z{};
    alignas(64) std::array<float, capacity> winding{};  ///< the result

    /// Of points no more than the capacity; at least one.
    explicit PointCluster(std::span<const glm::vec3> points);
};

/// As TriangleTree::winding, of all points of a cluster. A node stands for its triangles where it is far from all of them.
/// @param corners  of the triangles, in the tree's order
void sum_windings(std::span<const TriangleNode> nodes, std::span<const std::array<glm::vec3, 3>> corners,
                  PointCluster& points);

}  // namespace skinglow::detail
