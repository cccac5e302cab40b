#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "rays/embree_triangles.h"

namespace skinglow::testing {

constexpr std::uint32_t no_triangle = ~0U;

struct Hit {
    double distance = std::numeric_limits<double>::infinity();  ///< mm
    std::uint32_t triangle = no_triangle;
};

/// A mesh in mm, and moved and scaled for rays. Points and triangles must outlive it.
class RayBody {
  public:
    RayBody(std::span<const glm::dvec3> points, std::span<const glm::uvec3> triangles);

    /// The nearest triangle along a ray, either side of it, but the one it starts on: a plane is not met
    /// again.
    Hit hit(const glm::dvec3& from, const glm::dvec3& direction, std::uint32_t start_triangle) const;

    /// Barycentric coordinates of a point of a triangle.
    glm::dvec3 barycentric(std::uint32_t triangle, const glm::dvec3& point) const;

    /// More than its size away from the bounding box.
    bool is_far_from(const glm::dvec3& point) const;

    std::span<const glm::uvec3> triangles() const { return triangles_; }
    const glm::dvec3& point(std::uint32_t vertex) const { return points_[vertex]; }
    const glm::dvec3& normal(std::uint32_t triangle) const { return normals_[triangle]; }
    double area(std::uint32_t triangle) const { return areas_[triangle]; }

  private:
    glm::dvec3 to_box(const glm::dvec3& p) const { return (p - 0.5 * (low_ + high_)) / scale_; }

    std::span<const glm::dvec3> points_;
    std::span<const glm::uvec3> triangles_;
    glm::dvec3 low_;
    glm::dvec3 high_;
    double scale_ = 1;
    std::unique_ptr<EmbreeTriangles> rays_;
    std::vector<glm::dvec3> normals_;
    std::vector<double> areas_;
};

}  // namespace skinglow::testing
