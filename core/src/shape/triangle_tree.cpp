#include "shape/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>

#include "numerics/job.h"

namespace skinglow::detail {
namespace {

constexpr std::uint32_t leaf_size = 1;
/// A node is far from a point beyond this many of its radii.
constexpr float far_in_radii = 2.0F;

/// atan2 to 1e-4 radians, which is enough to tell inside from outside: a minimax polynomial on an eighth of a
/// turn.
float quick_angle(float y, float x) {
    const float ax = std::abs(x);
    const float ay = std::abs(y);
    const float high = std::max(ax, ay);
    if (high == 0) return 0;
    const float r = std::min(ax, ay) / high;
    const float s = r * r;
    float angle = ((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s * r + r;
    if (ay > ax) angle = 0.5F * std::numbers::pi_v<float> - angle;
    if (x < 0) angle = std::numbers::pi_v<float> - angle;
    return std::copysign(angle, y);
}

/// Half the solid angle of a triangle, positive seen from its inner side (A. van Oosterom and J. Strackee,
/// "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30(2), 1983).
float half_solid_angle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const float la = glm::length(a);
    const float lb = glm::length(b);
    const float lc = glm::length(c);
    const float above = glm::dot(a, glm::cross(b, c));
    const float below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return quick_angle(above, below);
}

/// Nearest point of a triangle, barycentric (C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
glm::vec2 nearest_of_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                              const glm::vec3& c) {
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const float d1 = glm::dot(ab, p - a);
    const float d2 = glm::dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    const float d3 = glm::dot(ab, p - b);
    const float d4 = glm::dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
    const float d5 = glm::dot(ab, p - c);
    const float d6 = glm::dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1 - w, w};
    }
    const float scale = 1 / (va + vb + vc);
    return {vb * scale, vc * scale};
}

}  // namespace

TriangleTree::TriangleTree(const Body& body) : body_(body) {
    const auto& triangles = body.triangles();
    order_.resize(triangles.size());
    centers_.resize(triangles.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        order_[i] = i;
        const BodyTriangle& t = triangles[i];
        centers_[i] = (body.corner(t, 0) + body.corner(t, 1) + body.corner(t, 2)) / 3.0F;
    }
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
    centers_ = {};
    place_.resize(order_.size());
    for (std::uint32_t k = 0; k < order_.size(); ++k) place_[order_[k]] = k;
    corners_.reserve(order_.size());
    for (const std::uint32_t i : order_)
        corners_.push_back(
            {body.corner(triangles[i], 0), body.corner(triangles[i], 1), body.corner(triangles[i], 2)});
}

void TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto& triangles = body_.triangles();
    const std::size_t index = nodes_.size();
    stop_if_asked(index);
    nodes_.emplace_back();
    glm::dvec3 center(0.0);
    glm::dvec3 dipole(0.0);
    double area = 0;
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (std::uint32_t i = begin; i < end; ++i) {
        const BodyTriangle& t = triangles[order_[i]];
        const auto weight = static_cast<double>(t.area);
        center += weight * glm::dvec3(centers_[order_[i]]);
        dipole += weight * glm::dvec3(t.normal);
        area += weight;
        low = glm::min(low, centers_[order_[i]]);
        high = glm::max(high, centers_[order_[i]]);
    }
    TriangleNode node{};
    node.center = center / area;
    node.dipole = dipole / (4 * std::numbers::pi);
    node.begin = begin;
    node.end = end;
    node.is_leaf = end - begin <= leaf_size;
    for (std::uint32_t i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k) {
            const float away = glm::length(body_.corner(triangles[order_[i]], k) - node.center);
            node.radius = std::max(node.radius, away);
        }
    }
    if (!node.is_leaf) {
        const glm::vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(
            order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
            [&](std::uint32_t a, std::uint32_t b) {
                return centers_[a][axis] != centers_[b][axis] ? centers_[a][axis] < centers_[b][axis] : a < b;
            });
        build(begin, middle);
        build(middle, end);
    }
    node.far_sq = far_in_radii * far_in_radii * node.radius * node.radius;
    node.skip = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index] = node;
}

double TriangleTree::winding(const glm::vec3& point) const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes_.size();) {
        const TriangleNode& node = nodes_[i];
        const glm::vec3 to = node.center - point;
        const float distance_sq = glm::dot(to, to);
        if (distance_sq > node.far_sq) {
            sum += static_cast<double>(glm::dot(node.dipole, to) / (distance_sq * std::sqrt(distance_sq)));
            i = node.skip;
            continue;
        }
        if (node.is_leaf) {
            float angle = 0;
            for (std::uint32_t k = node.begin; k < node.end; ++k) {
                const std::array<glm::vec3, 3>& t = corners_[k];
                angle += half_solid_angle(t[0] - point, t[1] - point, t[2] - point);
            }
            sum += static_cast<double>(angle) / (2 * std::numbers::pi);
        }
        ++i;
    }
    return sum;
}

void TriangleTree::windings(std::span<const glm::vec3> points, std::span<float> result) const {
    PointCluster cluster(points);
    sum_windings(nodes_, corners_, cluster);
    std::copy_n(cluster.winding.begin(), points.size(), result.begin());
}

std::span<const std::uint32_t> TriangleTree::neighborhood(std::uint32_t triangle) const {
    constexpr std::size_t size = PointCluster::capacity / 2;
    const std::size_t begin = place_[triangle] / size * size;
    return std::span(order_).subspan(begin, std::min(size, order_.size() - begin));
}

std::optional<SurfacePoint> TriangleTree::nearest(const glm::vec3& point, const glm::vec3& facing) const {
    std::optional<SurfacePoint> best;
    float best_distance = std::numeric_limits<float>::infinity();
    std::uint32_t best_place = 0;
    float best_facing = 0;
    // Points on edges are as near to either triangle, but for rounding: the one that faces along more, or the first.
    constexpr float same_distance = 1e-5F;  // of the body's size
    constexpr float same_facing = 1e-3F;
    const float tie = nodes_.empty() ? 0.0F : same_distance * nodes_[0].radius;
    const auto bound = [&](std::uint32_t node) {
        return glm::length(nodes_[node].center - point) - nodes_[node].radius;
    };
    // The nearer child first; halves of what is left leave no more than 32 open.
    struct Open {
        std::uint32_t node;
        float bound;
    };
    std::array<Open, 64> open;
    std::size_t count = 0;
    if (!nodes_.empty()) open[count++] = {0, bound(0)};
    while (count > 0) {
        const Open next = open[--count];
        if (next.bound > best_distance + tie) continue;
        const TriangleNode& node = nodes_[next.node];
        if (!node.is_leaf) {
            Open near{next.node + 1, bound(next.node + 1)};
            Open far{nodes_[near.node].skip, bound(nodes_[near.node].skip)};
            if (far.bound < near.bound) std::swap(near, far);
            open[count++] = far;
            open[count++] = near;
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k) {
            const BodyTriangle& t = body_.triangles()[order_[k]];
            const float along = glm::dot(facing, t.normal);
            if (facing != glm::vec3(0.0F) && along <= 0) continue;
            const glm::vec2 uv = nearest_of_triangle(point, corners_[k][0], corners_[k][1], corners_[k][2]);
            const float distance = glm::length(body_.at(t, uv.x, uv.y) - point);
            if (best && distance > best_distance - tie) {
                if (distance > best_distance + tie || along < best_facing - same_facing) continue;
                if (along <= best_facing + same_facing && k > best_place) continue;
            }
            best_distance = distance;
            best_place = k;
            best_facing = along;
            best = SurfacePoint{order_[k], uv.x, uv.y};
        }
    }
    return best;
}

}  // namespace skinglow::detail
