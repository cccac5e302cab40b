#pragma once

#include <skinglow/angular_weight.h>

#include <glm/vec3.hpp>
#include <vector>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// What an area light's light counts by its angles at a point: the mean of an angular weight over the light,
/// each part by the light it sends. The light's irradiance stays exact; only the ratio is a rule's.
///
/// A light whose half diagonal is seen under less than 1/50 radian counts at its center, one under less than
/// 1/4 at 4 points, others at 36 (32 of an ellipse): Gauss's points across a rectangle, or along an ellipse's
/// radius and evenly around it. Errors: docs/accuracy.md.
class AreaAngularWeight {
  public:
    /// @param light           of kind area
    /// @param angular_weight  has to outlive this
    AreaAngularWeight(const PreparedLight& light, const AngularWeight& angular_weight);

    /// @param normal  unit
    /// @return each channel, between the smallest and the largest weight
    glm::dvec3 mean(const glm::dvec3& point, const glm::dvec3& normal) const;

    struct Node {
        glm::dvec3 position;  ///< world
        double fraction;      ///< of the light's area
    };

  private:
    PreparedLight light_;
    const AngularWeight& angular_weight_;
    std::vector<Node> few_;
    std::vector<Node> many_;
};

}  // namespace skinglow::detail
