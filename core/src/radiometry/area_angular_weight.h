#pragma once

#include <skinglow/angular_weight.h>

#include <glm/vec3.hpp>
#include <vector>

#include "numerics/detail.h"
#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// What an area lamp's light counts by its angles at a place: the mean of an angular weight over the lamp,
/// each part by the light it sends. The lamp's irradiance stays exact; only the ratio is a rule's.
///
/// A lamp whose half diagonal is seen under less than 1/50 radian counts at its middle, one under less than
/// 1/4 at 4 places, others at 36 (32 of an ellipse): Gauss's points across a rectangle, or along an ellipse's
/// radius and evenly around it. Errors: docs/accuracy.md.
class AreaAngularWeight {
  public:
    /// @param light  of kind area; @param angular_weight  has to outlive this
    AreaAngularWeight(const PreparedLight& light, const AngularWeight& angular_weight);

    /// @param normal  unit; @return each channel, between the least and the largest weight
    glm::dvec3 mean(const glm::dvec3& point, const glm::dvec3& normal) const;

  private:
    struct Node {
        glm::dvec3 place;  ///< world
        double share;      ///< of the lamp's area
    };
    using Nodes = std::vector<Node>;

    PreparedLight light_;
    const AngularWeight& angular_weight_;
    double half_diagonal_;
    Nodes few_;
    Nodes many_;
};

}  // namespace skinglow::detail
