#include "shape/ray_body.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "geometry/vector.h"

namespace skinglow::testing {

RayBody::RayBody(std::span<const glm::dvec3> points, std::span<const glm::uvec3> triangles)
    : points_(points), triangles_(triangles) {
    low_ = glm::dvec3(std::numeric_limits<double>::infinity());
    high_ = -low_;
    for (const glm::dvec3& p : points) {
        low_ = glm::min(low_, p);
        high_ = glm::max(high_, p);
    }
    scale_ = std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z});
    std::vector<glm::dvec3> scaled;
    scaled.reserve(points.size());
    for (const glm::dvec3& p : points) scaled.push_back(to_box(p));
    rays_ = std::make_unique<EmbreeTriangles>(scaled, triangles);
    normals_.reserve(triangles.size());
    areas_.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        normals_.push_back(triangle_normal(points[t.x], points[t.y], points[t.z]));
        areas_.push_back(0.5 * glm::length(glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x])));
    }
}

Hit RayBody::hit(const glm::dvec3& from, const glm::dvec3& direction, std::uint32_t start_triangle) const {
    float nearest = std::numeric_limits<float>::infinity();
    std::uint32_t triangle = no_triangle;
    rays_->visit(to_box(from), direction, 0.0F, [&](float distance, std::uint32_t index) {
        if (index != start_triangle && distance < nearest) {
            nearest = distance;
            triangle = index;
        }
        return nearest;
    });
    if (triangle == no_triangle) return {};
    return {scale_ * static_cast<double>(nearest), triangle};
}

glm::dvec3 RayBody::barycentric(std::uint32_t triangle, const glm::dvec3& point) const {
    const glm::uvec3& t = triangles_[triangle];
    const glm::dvec3& n = normals_[triangle];
    const double y = 0.5 * glm::dot(n, glm::cross(points_[t.z] - point, points_[t.x] - point));
    const double z = 0.5 * glm::dot(n, glm::cross(points_[t.x] - point, points_[t.y] - point));
    const glm::dvec2 yz = glm::clamp(glm::dvec2(y, z) / areas_[triangle], 0.0, 1.0);
    return {1.0 - yz.x - yz.y, yz.x, yz.y};
}

bool RayBody::is_far_from(const glm::dvec3& p) const {
    const glm::dvec3 size = high_ - low_;
    for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] < low_[axis] - size[axis] || p[axis] > high_[axis] + size[axis]) return true;
    }
    return false;
}

}  // namespace skinglow::testing
