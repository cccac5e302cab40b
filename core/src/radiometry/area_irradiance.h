#pragma once

#include <skinglow/light.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A flat light in its own frame: it lies at z = 0 around the origin and shines towards +z with radiance
/// L g(t), g(t) = max(0, (tan s/2 - tan t) / (tan s/2 - s/2)) at an angle t to z and a spread s (g = 1 for s
/// = pi, a Lambert emitter; Blender's area lights, measured on 3.4 to 5.2).
class AreaEmitter {
  public:
    /// @param half_x  half width, above 0
    /// @param half_y  half width, above 0
    /// @param spread  full angle, radians, above 0, at most pi
    AreaEmitter(AreaShape shape, double half_x, double half_y, double spread);

    /// Irradiance at a point, divided by L; 0 behind the light. The part of the light below the receiver's
    /// horizon is cut. Rectangles without a spread are in closed form (J. H. Lambert's polygon formula,
    /// Photometria, 1760); the others are one integral along the rim, to a relative tolerance.
    /// @param point      in the light's frame
    /// @param normal     the receiver's, in the same frame, unit
    /// @param tolerance  of the integral, relative to area * cos / distance^2, above 0
    double irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const;

    double area() const;
    /// Largest g, on the axis: tan(s/2) / (tan(s/2) - s/2).
    double axis_gain() const { return spreads_ ? tan_half_ / spread_norm_ : 1.0; }
    /// g at an angle of that tangent.
    double gain(double tan_angle) const;

    AreaShape shape() const { return shape_; }
    double half_x() const { return half_x_; }
    double half_y() const { return half_y_; }
    /// Whether it is so narrow that the sums around its rim would cancel: it is integrated strip by strip.
    bool is_thin() const;
    bool spreads() const { return spreads_; }
    double half_spread() const { return half_spread_; }

  private:
    double rectangle_irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const;
    double ellipse_irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const;
    double edge_irradiance(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec3& point,
                           const glm::dvec3& normal, double tolerance) const;
    /// Distance of a point's foot to the box around the light; a lower bound of that to the light.
    double aside(const glm::dvec3& point) const;
    /// What absolute tolerances are a fraction of.
    double scale_at(const glm::dvec3& point) const;
    double strip_irradiance(double half_x, double half_y, const glm::dvec3& point, const glm::dvec3& normal,
                            double tolerance) const;

    AreaShape shape_;
    double half_x_;
    double half_y_;
    double half_spread_;
    bool spreads_;
    double tan_half_ = 0;
    double spread_norm_ = 1;
};

}  // namespace skinglow::detail
