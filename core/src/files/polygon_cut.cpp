#include "files/polygon_cut.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace skinglow::detail {
namespace {

/// Looks for each corner before a polygon is given up; common ones need some dozens.
constexpr std::uint64_t max_work_per_corner = 2000;
constexpr std::size_t leaf_size = 4;
constexpr std::uint32_t nothing = 0xFFFFFFFF;

/// The lower 16 bits with a gap of one after each.
std::uint32_t spread_bits(std::uint32_t bits) {
    bits = (bits | bits << 8U) & 0x00FF00FFU;
    bits = (bits | bits << 4U) & 0x0F0F0F0FU;
    bits = (bits | bits << 2U) & 0x33333333U;
    return (bits | bits << 1U) & 0x55555555U;
}

/// The diagonal of a quad from its first corner runs outside where the quad is concave at the second or
/// fourth.
bool first_diagonal_is_outside(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               const glm::dvec3& d) {
    return glm::dot(glm::cross(b - a, c - a), glm::cross(c - a, d - a)) < 0.0;
}

}  // namespace

bool PolygonCutter::cut(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> positions,
                        std::vector<glm::uvec3>& triangles) {
    const auto count = static_cast<std::uint32_t>(corners.size());
    if (count == 3) {
        triangles.emplace_back(corners[0], corners[1], corners[2]);
        return true;
    }
    if (count == 4) {
        const bool second = first_diagonal_is_outside(positions[corners[0]], positions[corners[1]],
                                                      positions[corners[2]], positions[corners[3]]);
        const std::size_t from = second ? 1 : 0;
        triangles.emplace_back(corners[from], corners[from + 1], corners[from + 2]);
        triangles.emplace_back(corners[from], corners[from + 2], corners[(from + 3) % 4]);
        return true;
    }
    project(corners, positions);
    link_corners();
    build_tree();
    std::uint32_t tip = 0;
    for (std::uint32_t left = count; left > 3; --left) {
        if (!next_ear(left, tip)) return false;
        triangles.emplace_back(corners[previous_[tip]], corners[tip], corners[next_[tip]]);
        clip(tip);
        tip = next_[tip];
    }
    triangles.emplace_back(corners[previous_[tip]], corners[tip], corners[next_[tip]]);
    return true;
}

void PolygonCutter::link_corners() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    previous_.resize(count);
    next_.resize(count);
    is_reflex_.resize(count);
    queued_at_.resize(count);
    first_waiting_.assign(count, nothing);
    waiting_.clear();
    queue_.clear();
    queue_front_ = work_ = cursor_ = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        previous_[i] = i == 0 ? count - 1 : i - 1;
        next_[i] = i + 1 == count ? 0 : i + 1;
        queue(i);
    }
    for (std::uint32_t i = 0; i < count; ++i)
        is_reflex_[i] = doubled_area(previous_[i], i, next_[i]) <= 0.0 ? 1 : 0;
}

/// The next corner to clip: an ear; where there is none, a corner on a straight line; where there is none
/// either, the polygon crosses itself and any corner must do. False when too much work was done.
bool PolygonCutter::next_ear(std::uint32_t left, std::uint32_t& tip) {
    const std::uint64_t max_work = max_work_per_corner * points_.size();
    while (queue_front_ < queue_.size()) {
        if (++work_ > max_work) return false;
        const std::size_t place = queue_front_++;
        const std::uint32_t corner = queue_[place];
        // A corner whose neighbor went waits for its turn, or a round polygon would end as a fan of slivers.
        if (queued_at_[corner] != place || doubled_area(previous_[corner], corner, next_[corner]) <= 0.0)
            continue;
        if (!is_free(corner)) continue;
        tip = corner;
        return true;
    }
    for (; next_[previous_[cursor_]] != cursor_; ++work_) {  // it was clipped
        cursor_ = static_cast<std::uint32_t>((cursor_ + 1) % points_.size());
    }
    for (std::uint32_t i = 0; i < left; ++i, cursor_ = next_[cursor_]) {
        if (++work_ > max_work) return false;
        if (doubled_area(previous_[cursor_], cursor_, next_[cursor_]) == 0.0) break;
    }
    tip = cursor_;
    return true;
}

void PolygonCutter::queue(std::uint32_t corner) {
    queued_at_[corner] = queue_.size();
    queue_.push_back(corner);
}

void PolygonCutter::clip(std::uint32_t tip) {
    const std::uint32_t before = previous_[tip];
    const std::uint32_t after = next_[tip];
    next_[before] = after;
    previous_[after] = before;
    unblock(tip);
    queued_at_[tip] = queue_.max_size();
    for (const std::uint32_t i : {before, after}) {
        if (is_reflex_[i] != 0 && doubled_area(previous_[i], i, next_[i]) > 0.0) unblock(i);
        queue(i);
    }
}

/// The corner blocks no ear any more.
void PolygonCutter::unblock(std::uint32_t corner) {
    if (is_reflex_[corner] == 0) return;
    is_reflex_[corner] = 0;
    for (std::size_t node = leaf_of(place_[corner]); node > 0; node /= 2) --nodes_[node].count;
    for (std::uint32_t i = first_waiting_[corner]; i != nothing; i = waiting_[i].next) {
        if (queued_at_[waiting_[i].tip] < queue_front_) queue(waiting_[i].tip);
    }
    first_waiting_[corner] = nothing;
}

/// Along the axis that the polygon's plane faces most, relative to its first corner, so that far from the
/// origin nothing is lost.
void PolygonCutter::project(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> positions) {
    // By a power of two, which changes no digit: differences and products of coordinates near the largest double would overflow.
    double largest = 0.0;
    for (const std::uint32_t corner : corners) {
        const glm::dvec3 size = glm::abs(positions[corner]);
        largest = std::max({largest, size.x, size.y, size.z});
    }
    const int exponent = largest > 0.0 ? std::ilogb(largest) : 0;
    const auto scaled = [&](std::uint32_t corner) {
        const glm::dvec3& p = positions[corner];
        return glm::dvec3(std::ldexp(p.x, -exponent), std::ldexp(p.y, -exponent), std::ldexp(p.z, -exponent));
    };
    const glm::dvec3 origin = scaled(corners[0]);
    glm::dvec3 normal(0.0);
    for (std::size_t i = 2; i < corners.size(); ++i) {
        normal += glm::cross(scaled(corners[i - 1]) - origin, scaled(corners[i]) - origin);
    }
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double sign = normal[axis] < 0.0 ? -1.0 : 1.0;
    points_.clear();
    for (const std::uint32_t corner : corners) {
        const glm::dvec3 offset = scaled(corner) - origin;
        points_.emplace_back(sign * offset[u], offset[v]);
    }
}

void PolygonCutter::build_tree() {
    glm::dvec2 low = points_.front();
    glm::dvec2 high = low;
    reflex_.clear();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        low = glm::min(low, points_[i]);
        high = glm::max(high, points_[i]);
        if (is_reflex_[i] != 0) reflex_.push_back(i);
    }
    constexpr double least_size = 1e-300;  // of points in one line: 65535 times its inverse is a number, too
    const glm::dvec2 scale = 65535.0 / glm::max(high - low, glm::dvec2(least_size));
    std::vector<std::uint32_t> codes(points_.size());
    for (const std::uint32_t i : reflex_) {
        const glm::dvec2 place = glm::min((points_[i] - low) * scale, glm::dvec2(65535.0));
        codes[i] = spread_bits(static_cast<std::uint32_t>(place.x)) |
                   spread_bits(static_cast<std::uint32_t>(place.y)) << 1U;
    }
    std::sort(reflex_.begin(), reflex_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    leaves_ = std::bit_ceil(std::max<std::size_t>(1, reflex_.size() / leaf_size));
    nodes_.assign(2 * leaves_, Node{high, low, 0});
    place_.resize(points_.size());
    for (std::size_t i = 0; i < reflex_.size(); ++i) {
        place_[reflex_[i]] = static_cast<std::uint32_t>(i);
        Node& leaf = nodes_[leaf_of(i)];
        leaf.low = glm::min(leaf.low, points_[reflex_[i]]);
        leaf.high = glm::max(leaf.high, points_[reflex_[i]]);
        ++leaf.count;
    }
    for (std::size_t i = leaves_; i-- > 1;) {
        const Node& a = nodes_[2 * i];
        const Node& b = nodes_[2 * i + 1];
        nodes_[i] = {glm::min(a.low, b.low), glm::max(a.high, b.high), a.count + b.count};
    }
}

/// The leaf of a slot in `reflex_`: the leaves share these evenly.
std::size_t PolygonCutter::leaf_of(std::size_t place) const {
    return leaves_ + place * leaves_ / reflex_.size();
}

double PolygonCutter::doubled_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec2 first = points_[b] - points_[a];
    const glm::dvec2 second = points_[c] - points_[a];
    return first.x * second.y - first.y * second.x;
}

/// Whether no reflex corner blocks the ear; else it waits for one that does.
bool PolygonCutter::is_free(std::uint32_t tip) {
    std::array<std::size_t, 64> stack{1};
    for (std::size_t size = 1; size > 0;) {
        const std::size_t node = stack[--size];
        ++work_;
        if (!may_overlap(nodes_[node], tip)) continue;
        if (node < leaves_) {
            stack[size++] = 2 * node;
            stack[size++] = 2 * node + 1;
            continue;
        }
        const std::size_t leaf = node - leaves_;
        const std::size_t end = ((leaf + 1) * reflex_.size() + leaves_ - 1) / leaves_;
        for (std::size_t i = (leaf * reflex_.size() + leaves_ - 1) / leaves_; i < end; ++i, ++work_) {
            const std::uint32_t corner = reflex_[i];
            if (!blocks(corner, tip)) continue;
            waiting_.push_back({tip, first_waiting_[corner]});
            first_waiting_[corner] = static_cast<std::uint32_t>(waiting_.size() - 1);
            return false;
        }
    }
    return true;
}

/// Whether the box may have a corner within the ear: it lies on the inner side of each edge, if only in part.
bool PolygonCutter::may_overlap(const Node& node, std::uint32_t tip) const {
    if (node.count == 0) return false;
    const std::array corners = {points_[previous_[tip]], points_[tip], points_[next_[tip]]};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec2 innermost(edge.y > 0.0 ? node.low.x : node.high.x,
                                   edge.x > 0.0 ? node.high.y : node.low.y);
        const glm::dvec2 offset = innermost - corners[i];
        if (edge.x * offset.y - edge.y * offset.x < 0.0) return false;
    }
    const glm::dvec2 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
    const glm::dvec2 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
    return low.x <= node.high.x && low.y <= node.high.y && high.x >= node.low.x && high.y >= node.low.y;
}

/// Whether a reflex corner lies within the ear or on its rim, but not at one of its corners.
bool PolygonCutter::blocks(std::uint32_t corner, std::uint32_t tip) const {
    if (is_reflex_[corner] == 0) return false;
    const std::uint32_t before = previous_[tip];
    const std::uint32_t after = next_[tip];
    const glm::dvec2& point = points_[corner];
    if (point == points_[before] || point == points_[tip] || point == points_[after]) return false;
    return doubled_area(before, tip, corner) >= 0.0 && doubled_area(tip, after, corner) >= 0.0 &&
           doubled_area(after, before, corner) >= 0.0;
}

}  // namespace skinglow::detail
