#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Texels this near to a corner or an edge of a triangle lie on it.
constexpr double on_edge = 0.01;

/// A triangle in texels.
class TexelTriangle {
  public:
    TexelTriangle() = default;
    /// @param corners  x and y in texels; z, the tile, is not looked at
    explicit TexelTriangle(std::span<const glm::vec3, 3> corners);

    /// Whether a renderer that interpolates four texels may read one of this triangle's points from that texel.
    bool reads(const glm::dvec2& texel) const {
        constexpr double slack = 1 + 5e-4;  // for rounding; less than a face is from its tile's border
        // The square of points that read a texel has half an edge of 1: apart from the triangle along one of the axes
        // or of its edges' normals, or not at all.
        if (texel.x < low_.x - slack || texel.y < low_.y - slack || texel.x > high_.x + slack ||
            texel.y > high_.y + slack)
            return false;
        if (area_ == 0) return true;
        for (int k = 0; k < 3; ++k) {
            if (side(k, texel) < -slack * (std::abs(inward_[k].x) + std::abs(inward_[k].y))) return false;
        }
        return true;
    }
    /// Distance of a texel within from the nearest edge; negative without, and of a triangle without area.
    double depth(const glm::dvec2& texel) const {
        if (area_ == 0) return -1;
        return std::min({side(0, texel) / length_.x, side(1, texel) / length_.y, side(2, texel) / length_.z});
    }
    glm::dvec2 at(const glm::dvec3& weights) const {
        return weights.x * corners_[0] + weights.y * corners_[1] + weights.z * corners_[2];
    }
    /// Weights of the corners, of sum 1; beyond an edge that of the corner across is negative. Of a triangle
    /// without area those of its nearest point.
    glm::dvec3 weights(const glm::dvec2& texel) const;
    /// Weights of the nearest point of the edges.
    glm::dvec3 nearest(const glm::dvec2& texel) const;
    /// Weights of a texel with a depth of -on_edge or more, moved onto a corner or an edge that is within on_edge.
    glm::dvec3 snapped(const glm::dvec2& texel) const;

    /// Of the edge across from corner k, texels.
    double edge_length(int k) const { return length_[k]; }
    const glm::dvec2& low() const { return low_; }
    const glm::dvec2& high() const { return high_; }
    /// 0: not above rounding.
    double area() const { return area_; }

  private:
    double side(int k, const glm::dvec2& texel) const {
        return glm::dot(inward_[k], texel - corners_[(k + 1) % 3]);
    }

    // Three columns of two rows, indexed by int as vectors are.
    glm::dmat3x2 corners_{0.0};
    glm::dmat3x2 inward_{0.0};  ///< normal of the edge across from corner k; length: that of the edge
    glm::dvec3 length_{0.0};
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    double area_ = 0;
};

}  // namespace skinglow::detail
