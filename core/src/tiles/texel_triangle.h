#pragma once

#include <array>
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
    /// @param corners  x and y in texels; z, the tile, is not looked at
    explicit TexelTriangle(std::span<const glm::vec3, 3> corners);

    /// Whether a renderer that interpolates four texels may read one of this triangle's points from that texel.
    bool reads(const glm::dvec2& texel) const;
    /// Of a texel from the triangle; 0 within and on its edges.
    double distance(const glm::dvec2& texel) const;
    /// Weights of the corners, of sum 1; beyond an edge that of the corner across is negative. Of a triangle
    /// without area those of its nearest point.
    glm::dvec3 weights(const glm::dvec2& texel) const;
    /// Weights of the nearest point of the edges.
    glm::dvec3 nearest(const glm::dvec2& texel) const;
    /// Weights of a texel within, moved onto a corner or an edge that is within on_edge.
    glm::dvec3 snapped(const glm::dvec2& texel) const;

    /// Of the edge across from corner k, texels.
    double edge_length(int k) const { return length_[k]; }
    const glm::dvec2& low() const { return low_; }
    const glm::dvec2& high() const { return high_; }
    /// 0: not above rounding.
    double area() const { return area_; }

  private:
    double side(int k, const glm::dvec2& texel) const;
    glm::dvec2 at(const glm::dvec3& weights) const;

    std::array<glm::dvec2, 3> corners_{};
    std::array<glm::dvec2, 3>
        inward_{};  ///< normal of the edge across from corner k; length: that of the edge
    glm::dvec3 length_{0.0};
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    double area_ = 0;
};

}  // namespace skinglow::detail
