#pragma once

#include <skinglow/mesh.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A triangle with area of a body.
struct BodyTriangle {
    glm::uvec3 corners;  ///< vertices of the mesh given: irradiance is known there
    glm::uvec3 welded;   ///< the same without seams
    glm::vec3 normal;    ///< unit, outward
    float area;          ///< mm^2
};

/// A mesh as the surface of flesh, in mm about the center of its box. Vertices at one position are one
/// vertex, repeated triangles count once, a triangle and its mirror image cancel, triangles without area are
/// left out. Faces whose winding is against their neighbors' are turned, where edges say so, to the winding
/// of the larger area of the connected piece; a mesh that encloses a negative volume is turned as a whole.
class Body {
  public:
    /// @param unit_mm  length of one unit of the mesh, mm, above 0
    /// @throws std::invalid_argument where the extent is beyond ten kilometers
    Body(const MeshView& mesh, double unit_mm);

    /// One per welded vertex, mm.
    const std::vector<glm::vec3>& positions() const { return positions_; }
    const std::vector<BodyTriangle>& triangles() const { return triangles_; }
    /// For each vertex given, its welded one.
    const std::vector<std::uint32_t>& welded_of() const { return welded_of_; }
    /// Triangles at a welded vertex, ascending.
    std::span<const std::uint32_t> triangles_at(std::uint32_t welded) const {
        return {at_.data() + begin_[welded], begin_[welded + 1] - begin_[welded]};
    }
    /// The point given, in mm about the center.
    glm::vec3 local(const glm::dvec3& point) const { return (point - origin_) * unit_mm_; }
    const glm::dvec3& origin() const { return origin_; }
    /// Mean curvature at each welded vertex, 1/mm, above 0 where the body is convex; a mean over the vertices about it.
    const std::vector<float>& curvature() const { return curvature_; }
    glm::vec3 corner(const BodyTriangle& t, int k) const { return positions_[t.welded[k]]; }
    glm::vec3 at(const BodyTriangle& t, float u, float v) const {
        return corner(t, 0) * (1 - u - v) + corner(t, 1) * u + corner(t, 2) * v;
    }

  private:
    /// Vertices of no triangle are put to the center: wherever they are, they are no part of the body's extent.
    void settle_loose_vertices(std::span<const glm::uvec3> triangles);
    void add_triangles(std::span<const glm::uvec3> triangles);
    void turn_outward();
    void index_triangles();
    void find_curvature();

    glm::dvec3 origin_{0.0};
    double unit_mm_;
    std::vector<glm::vec3> positions_;
    std::vector<BodyTriangle> triangles_;
    std::vector<std::uint32_t> welded_of_;
    std::vector<std::uint32_t> begin_;
    std::vector<std::uint32_t> at_;
    std::vector<float> curvature_;
};

}  // namespace skinglow::detail
