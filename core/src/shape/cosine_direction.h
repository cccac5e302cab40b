#pragma once

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Right-handed frame about a unit axis (T. Duff et al., "Building an orthonormal basis, revisited", JCGT
/// 6(1), 2017).
inline glm::mat3 frame_about(const glm::vec3& axis) {
    const float sign = std::copysign(1.0F, axis.z);
    const float a = -1 / (sign + axis.z);
    const float b = axis.x * axis.y * a;
    return {{1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x},
            {b, sign + axis.y * axis.y * a, -axis.y},
            axis};
}

/// A direction about an axis, distributed as the cosine, of two numbers from 0 to 1.
inline glm::vec3 cosine_direction(const glm::vec3& axis, float u, float v) {
    const float radius = std::sqrt(u);
    const float angle = 2 * std::numbers::pi_v<float> * v;
    return frame_about(axis) *
           glm::vec3(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u));
}

}  // namespace skinglow::detail
