#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace skinglow {

/// Rec.709 luminance Y of a linear color (ITU-R BT.709-6, item 3.2 of part 1).
inline double luminance(const glm::dvec3& linear_rgb) {
    return glm::dot(linear_rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace skinglow
