#include "geometry/vector.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace skinglow::detail {

double length(const glm::dvec3& v) {
    const double length_sq = glm::dot(v, v);
    if (length_sq > 1e-280 && length_sq < 1e280) return std::sqrt(length_sq);
    return std::hypot(v.x, v.y, v.z);
}

glm::dvec3 unit(const glm::dvec3& v) {
    const double length_sq = glm::dot(v, v);
    if (length_sq > 1e-280 && length_sq < 1e280) return v / std::sqrt(length_sq);
    // By the exponent: a quotient of two subnormal numbers has lost digits, a power of two has not.
    const int exponent = std::ilogb(max_abs(v));
    const glm::dvec3 scaled(std::scalbn(v.x, -exponent), std::scalbn(v.y, -exponent),
                            std::scalbn(v.z, -exponent));
    return scaled / glm::length(scaled);
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(length(glm::cross(a, b)), glm::dot(a, b));
}

double max_abs(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

glm::dvec3 triangle_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    constexpr double min_area = 1e-12;  // of the parallelogram, relative to the squared longest edge
    // Halves, because the difference of two huge coordinates may overflow; then at a size of about 1, so that
    // no square over- or underflows.
    glm::dvec3 u = 0.5 * b - 0.5 * a;
    glm::dvec3 v = 0.5 * c - 0.5 * a;
    const double size = std::max(max_abs(u), max_abs(v));
    if (size == 0.0) return glm::dvec3(0.0);
    u /= size;
    v /= size;
    const glm::dvec3 normal = glm::cross(u, v);
    const double area = glm::length(normal);
    const double longest_sq = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(v - u, v - u)});
    return area > min_area * longest_sq ? normal / area : glm::dvec3(0.0);
}

bool is_orthogonal(const glm::dmat3& matrix, double tolerance) {
    const glm::dmat3 error = glm::transpose(matrix) * matrix - glm::dmat3(1.0);
    for (int i = 0; i < 9; ++i) {
        if (!(std::abs(error[i / 3][i % 3]) < tolerance)) return false;
    }
    return true;
}

glm::dmat3 frame_around(const glm::dvec3& unit_axis) {
    const glm::dvec3 size = glm::abs(unit_axis);
    const glm::dvec3 least_aligned = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                                     : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                          : glm::dvec3(0, 0, 1);
    const glm::dvec3 x = glm::normalize(glm::cross(least_aligned, unit_axis));
    return {x, glm::cross(unit_axis, x), unit_axis};
}

glm::dmat3 frame_around(const glm::dvec3& direction, const glm::dvec3& tangent) {
    const glm::dvec3 z = unit(direction);
    if (tangent != glm::dvec3(0.0)) {
        const glm::dvec3 along = unit(tangent);
        const glm::dvec3 across = along - glm::dot(along, z) * z;
        if (glm::length(across) > 1e-9) {
            const glm::dvec3 x = glm::normalize(across);
            return {x, glm::cross(z, x), z};
        }
    }
    return frame_around(z);
}

}  // namespace skinglow::detail
