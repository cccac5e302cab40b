#include "geometry/welded_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow::detail {

WeldedMesh::WeldedMesh(const MeshView& mesh) : weld_(weld(mesh.vertices())) {
    normalize(mesh);
    add_triangles(mesh.triangles());
    orient_outwards();
    index_triangles();
}

void WeldedMesh::normalize(const MeshView& mesh) {
    positions_.assign(weld_.first.size(), glm::dvec3(0.0));
    // What no triangle uses must not cost precision: a stray point far off would shrink the mesh in its box.
    const auto box = box_of({&mesh, 1});
    if (!box) return;
    const double half_extent = max_abs(box->half_extent());
    if (half_extent == 0.0) return;
    scale_ = 2.0 * half_extent;
    diagonal_ = 2.0 * box->radius();
    if (!std::isfinite(diagonal_)) {
        refuse_argument("vertices", "a mesh as large as " + to_text(box->max - box->min),
                        "an extent below the largest double");
    }
    for (std::size_t i = 0; i < positions_.size(); ++i)
        positions_[i] = (mesh.vertices()[weld_.first[i]] - box->center()) / half_extent * 0.5;
}

void WeldedMesh::add_triangles(std::span<const glm::uvec3> triangles) {
    triangles_.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        const glm::uvec3 corners(weld_.index[t.x], weld_.index[t.y], weld_.index[t.z]);
        const glm::dvec3& p = positions_[corners.x];
        const glm::dvec3 normal = triangle_normal(p, positions_[corners.y], positions_[corners.z]);
        if (normal != glm::dvec3(0.0)) triangles_.push_back({corners, normal, glm::dot(normal, p)});
    }
}

void WeldedMesh::orient_outwards() {
    // Six times the volume, by the divergence theorem, about the box's center: an open head has a clear sign,
    // too.
    double volume = 0;
    for (const WeldedTriangle& t : triangles_) {
        const glm::dvec3& p = positions_[t.corners.x];
        volume += glm::dot(p, glm::cross(positions_[t.corners.y], positions_[t.corners.z]));
    }
    // The volume of a plane through the center is rounding: it keeps its winding.
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
    const double size = glm::length(sum);
    return size > 1e-9 * angles ? sum / size : glm::dvec3(0);
}

}  // namespace skinglow::detail
