#include "geometry/welded_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "geometry/mesh_check.h"
#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow {
namespace {

bool position_less(const glm::dvec3& a, const glm::dvec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

}  // namespace

WeldedMesh::WeldedMesh(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles) {
    require_mesh("", vertices, triangles);
    weld(vertices);
    normalize(vertices, triangles);
    add_triangles(triangles);
    orient_outwards();
    index_triangles();
}

void WeldedMesh::weld(std::span<const glm::dvec3> vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (position_less(vertices[a], vertices[b])) return true;
        return !position_less(vertices[b], vertices[a]) && a < b;
    });
    weld_of_.resize(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        // glm's == holds 0 and -0 for equal, as the order above does.
        if (i == 0 || vertices[order[i]] != vertices[order[i - 1]]) first_of_weld_.push_back(order[i]);
        weld_of_[order[i]] = static_cast<std::uint32_t>(first_of_weld_.size() - 1);
    }
}

void WeldedMesh::normalize(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles) {
    positions_.assign(first_of_weld_.size(), glm::dvec3(0));
    if (triangles.empty()) return;
    // What no triangle uses must not cost precision: a stray point far off would shrink the mesh in its box.
    glm::dvec3 low = vertices[triangles[0].x];
    glm::dvec3 high = low;
    for (const glm::uvec3& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, vertices[t[k]]);
            high = glm::max(high, vertices[t[k]]);
        }
    }
    // Halves first: the sum or difference of two huge coordinates may overflow where their halves do not.
    const glm::dvec3 center = 0.5 * low + 0.5 * high;
    const glm::dvec3 half_extent = 0.5 * high - 0.5 * low;
    const double largest = std::max({half_extent.x, half_extent.y, half_extent.z});
    if (largest == 0) return;
    scale_ = 2.0 * largest;
    diagonal_ = scale_ * glm::length(half_extent / largest);
    if (!std::isfinite(diagonal_)) {
        refuse_argument("vertices", "a mesh as large as " + to_text(high - low),
                        "an extent below the largest double");
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        positions_[i] = (vertices[first_of_weld_[i]] - center) / largest * 0.5;
    }
}

void WeldedMesh::add_triangles(std::span<const glm::uvec3> triangles) {
    triangles_.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        const glm::uvec3 corners(weld_of_[t.x], weld_of_[t.y], weld_of_[t.z]);
        const glm::dvec3& p = positions_[corners.x];
        const glm::dvec3 a = positions_[corners.y] - p;
        const glm::dvec3 b = positions_[corners.z] - p;
        const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(b - a, b - a)});
        const glm::dvec3 doubled_area = glm::cross(a, b);
        const double area = glm::length(doubled_area);
        if (!has_area(area, longest)) continue;
        const glm::dvec3 normal = doubled_area / area;
        triangles_.push_back({corners, normal, glm::dot(normal, p)});
    }
}

void WeldedMesh::orient_outwards() {
    // Six times the volume, by the divergence theorem, about the box's center: also an open head has a clear
    // sign.
    double volume = 0;
    for (const WeldedTriangle& t : triangles_) {
        const glm::dvec3& p = positions_[t.corners.x];
        volume += glm::dot(p, glm::cross(positions_[t.corners.y], positions_[t.corners.z]));
    }
    // A plane through the center has a volume of rounding errors: it is left as it is wound.
    if (volume > -1e-9) return;
    for (WeldedTriangle& t : triangles_) {
        std::swap(t.corners.y, t.corners.z);
        t.unit_normal = -t.unit_normal;
        t.plane = -t.plane;
    }
}

void WeldedMesh::index_triangles() {
    triangle_begin_.assign(positions_.size() + 1, 0);
    for (const WeldedTriangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) ++triangle_begin_[t.corners[k] + 1];
    }
    std::partial_sum(triangle_begin_.begin(), triangle_begin_.end(), triangle_begin_.begin());
    triangle_list_.resize(3 * triangles_.size());
    std::vector<std::uint32_t> next(triangle_begin_.begin(), triangle_begin_.end() - 1);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        for (int k = 0; k < 3; ++k) triangle_list_[next[triangles_[i].corners[k]]++] = i;
    }
}

std::span<const std::uint32_t> WeldedMesh::triangles_at(std::uint32_t welded) const {
    return {triangle_list_.data() + triangle_begin_[welded],
            triangle_list_.data() + triangle_begin_[welded + 1]};
}

glm::dvec3 WeldedMesh::vertex_normal(std::uint32_t welded) const {
    glm::dvec3 sum(0);
    double angles = 0;
    for (const std::uint32_t index : triangles_at(welded)) {
        const WeldedTriangle& t = triangles_[index];
        const int k = t.corners.x == welded ? 0 : t.corners.y == welded ? 1 : 2;
        const glm::dvec3& p = positions_[welded];
        const double angle =
            angle_between(positions_[t.corners[(k + 1) % 3]] - p, positions_[t.corners[(k + 2) % 3]] - p);
        sum += angle * t.unit_normal;
        angles += angle;
    }
    const double length = glm::length(sum);
    return length > 1e-9 * angles ? sum / length : glm::dvec3(0);
}

}  // namespace skinglow
