#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// The radial half of the integral over a flat light whose radiance is (T - tan t) up to the angle whose
/// tangent is T. About the foot of the perpendicular from the receiver to the light's plane, with x = tan t
/// the distance to the foot in units of the height, a wedge d(phi) out to x contributes
///   d(phi) * integral from 0 to min(x, T) of (T - x) (x n_phi - n_z) x / (1 + x^2)^2 dx,
/// n the receiver's normal, n_phi its component along the wedge. Everything is in closed form but the path
/// around the rim.
class SpreadIntegral {
  public:
    explicit SpreadIntegral(double tan_half) : tan_half_(tan_half) {}

    /// The integral along a ray from the foot out to a point, which is in units of the height.
    /// @param normal  receiver's normal n
    double along_ray(const glm::dvec2& point, const glm::dvec3& normal) const;

    /// Integral over the triangle between the foot (origin) and the straight edge a to b, in units of the
    /// height; signed, counter-clockwise positive.
    /// @param normal     receiver's normal
    /// @param tolerance  absolute
    double edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec3& normal, double tolerance) const;

  private:
    double tan_half_;
};

/// Below it closed forms cancel, and the series, cut at x^10, are exact to 1e-13.
constexpr double small_tangent = 0.05;

/// (tan(a) - a) / tan(a)^3 by its series in tan(a)^2, for tangents below small_tangent.
constexpr double tangent_series(double s) {
    return 1.0 / 3 + s * (-1.0 / 5 + s * (1.0 / 7 + s * (-1.0 / 9 + s / 11)));
}

/// tan(a) - a without cancellation, for a given tan(a) of 0 or more.
double tangent_minus_angle(double tangent);

}  // namespace skinglow::detail
