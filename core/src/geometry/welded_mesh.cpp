#include "geometry/welded_mesh.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow::detail {

WeldedMesh::WeldedMesh(const MeshView& mesh) : weld_(weld(mesh.vertices())) {
    normalize(mesh);
    add_triangles(mesh.triangles());
    orient_outwards();
    add_normals();
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

void WeldedMesh::add_normals() {
    normals_.assign(positions_.size(), glm::dvec3(0.0));
    std::vector<double> angles(positions_.size());
    for (const WeldedTriangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3& p = positions_[t.corners[k]];
            const double angle =
                angle_between(positions_[t.corners[(k + 1) % 3]] - p, positions_[t.corners[(k + 2) % 3]] - p);
            normals_[t.corners[k]] += angle * t.unit_normal;
            angles[t.corners[k]] += angle;
        }
    }
    for (std::size_t i = 0; i < normals_.size(); ++i) {
        const double size = glm::length(normals_[i]);
        normals_[i] = size > 1e-9 * angles[i] ? normals_[i] / size : glm::dvec3(0.0);
    }
}

}  // namespace skinglow::detail
