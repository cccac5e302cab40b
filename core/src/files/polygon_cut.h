#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Cuts polygons into triangles by clipping ears, concave ones too. An ear can only be blocked by reflex
/// corners, which a tree of boxes finds; a blocked one is looked at again when what blocked it is gone.
/// Polygons that cross themselves are cut somehow.
class PolygonCutter {
  public:
    /// Appends the triangles of one polygon, two fewer than corners, wound as the polygon is.
    /// @param corners    indices into `positions`, at least 3
    /// @return false where the polygon is too intricate to be cut within a bounded time
    bool cut(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> positions,
             std::vector<glm::uvec3>& triangles);

  private:
    void project(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> positions);
    void link_corners();
    void build_tree();
    std::size_t leaf_of(std::size_t place) const;
    double doubled_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool next_ear(std::uint32_t left, std::uint32_t& tip);
    bool is_free(std::uint32_t tip);
    bool blocks(std::uint32_t corner, std::uint32_t tip) const;
    void queue(std::uint32_t corner);
    void clip(std::uint32_t tip);
    void unblock(std::uint32_t corner);

    std::vector<glm::dvec2> points_;  ///< the corners in the polygon's plane, which it runs around leftwards
    std::vector<std::uint32_t> previous_, next_;
    std::vector<std::uint8_t> is_reflex_;
    std::vector<std::uint32_t> queue_;    ///< corners to look at
    std::vector<std::size_t> queued_at_;  ///< of each corner, its last place in the queue
    std::size_t queue_front_ = 0;
    std::vector<std::uint32_t>
        first_waiting_;  ///< of each reflex corner, the list of the tips that it blocks
    struct Waiting {
        std::uint32_t tip, next;
    };
    std::vector<Waiting> waiting_;
    std::uint32_t cursor_ = 0;  ///< where the search for a corner goes on when there is no ear
    struct Node {
        glm::dvec2 low, high;     ///< box around its reflex corners
        std::uint32_t count = 0;  ///< how many of them are still there
    };
    bool may_overlap(const Node& node, std::uint32_t tip) const;

    std::vector<Node> nodes_;            ///< a binary tree; the children of i are 2 i and 2 i + 1
    std::vector<std::uint32_t> reflex_;  ///< the reflex corners, near ones close to each other, by leaf
    std::vector<std::uint32_t> place_;   ///< of each corner, in `reflex_`
    std::size_t leaves_ = 1;
    std::uint64_t work_ = 0;  ///< corners and boxes looked at
};

}  // namespace skinglow::detail
