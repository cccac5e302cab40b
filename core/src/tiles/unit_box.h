#pragma once

#include <skinglow/box.h>

#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Moves points to the origin and scales a box to that of unit edge, so that no square of a length over- or underflows.
class UnitBox {
  public:
    /// Throws std::invalid_argument on a box whose extent is beyond the largest double.
    explicit UnitBox(const Box& box);

    /// Points far outside the box come to lie near it.
    glm::dvec3 operator()(const glm::dvec3& point) const;
    /// Length of the box's longest edge, above 0.
    double scale() const { return scale_; }

  private:
    glm::dvec3 half_center_;
    double scale_;
};

}  // namespace skinglow::detail
