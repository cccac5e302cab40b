#include "tiles/texel_triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace skinglow::detail {

TexelTriangle::TexelTriangle(std::span<const glm::vec3, 3> corners) {
    corners_ = {glm::dvec2(corners[0]), glm::dvec2(corners[1]), glm::dvec2(corners[2])};
    low_ = glm::min(corners_[0], glm::min(corners_[1], corners_[2]));
    high_ = glm::max(corners_[0], glm::max(corners_[1], corners_[2]));
    const glm::dvec2 u = corners_[1] - corners_[0];
    const glm::dvec2 v = corners_[2] - corners_[0];
    const double twice = u.x * v.y - u.y * v.x;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 edge = corners_[(k + 2) % 3] - corners_[(k + 1) % 3];
        inward_[k] = twice < 0 ? glm::dvec2(edge.y, -edge.x) : glm::dvec2(-edge.y, edge.x);
        length_[k] = glm::length(edge);
    }
    const double longest = std::max({length_.x, length_.y, length_.z});
    constexpr double flat = 1e-4;  // height over the longest edge, texels; single precision has no less
    if (std::abs(twice) > flat * std::max(longest, flat)) area_ = 0.5 * std::abs(twice);
}

glm::dvec3 TexelTriangle::weights(const glm::dvec2& texel) const {
    if (area_ == 0) return nearest(texel);
    const glm::dvec3 w(side(0, texel), side(1, texel), side(2, texel));
    return w / (w.x + w.y + w.z);
}

glm::dvec3 TexelTriangle::nearest(const glm::dvec2& texel) const {
    glm::dvec3 found(1.0, 0.0, 0.0);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const int from = (k + 1) % 3;
        const int to = (k + 2) % 3;
        const glm::dvec2 along = corners_[to] - corners_[from];
        glm::dvec3 w(0.0);
        if (length_[k] > 0)
            w[to] = std::clamp(glm::dot(texel - corners_[from], along) / glm::dot(along, along), 0.0, 1.0);
        w[from] = 1 - w[to];
        const double distance = glm::length(texel - at(w));
        if (distance < least) {
            least = distance;
            found = w;
        }
    }
    return found;
}

glm::dvec3 TexelTriangle::snapped(const glm::dvec2& texel) const {
    if (depth(texel) > on_edge) return weights(texel);
    for (int k = 0; k < 3; ++k) {
        if (glm::length(texel - corners_[k]) > on_edge) continue;
        glm::dvec3 corner(0.0);
        corner[k] = 1;
        return corner;
    }
    return nearest(texel);
}

}  // namespace skinglow::detail
