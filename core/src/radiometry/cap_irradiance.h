#pragma once

#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// How a spot fades from its axis to the edge of its cone: smoothstep((cos t - cos half) / (blend (1 - cos
/// half))), as Blender's renderers have it (measured on 3.4 to 5.2); the total is not raised when the cone
/// narrows.
class SpotProfile {
  public:
    /// @param angle        full angle of the cone, radians, 0 (no light) to pi
    /// @param blend        0 (hard edge) to 1
    /// @param with_cosine  also times cos t (Blender 3.4)
    SpotProfile(double angle, double blend, bool with_cosine);

    /// Fraction of the light at an angle to the axis, in [0, 1]; falls with the angle.
    double at(double cos_angle) const;

    /// Angle beyond which there is no light, and angle within which the cone does not fade, radians.
    double edge() const { return edge_; }
    double fade_start() const { return fade_start_; }
    double cos_edge() const { return cos_edge_; }
    double cos_fade_start() const { return cos_edge_ + fade_; }
    bool with_cosine() const { return with_cosine_; }

  private:
    double edge_;
    double cos_edge_;
    double fade_;  ///< width of the fading rim, in cosine
    double fade_start_;
    bool with_cosine_;
};

/// Irradiance from a round patch of sky of uniform radiance L, cut off by the receiver's horizon, as a fraction
/// of what a receiver facing its center gets (pi L sin^2): the whole of a ball, a facing disk or a sun that a
/// face sees.
///
/// @param cos_normal  cosine between the receiver's normal and the center of the patch, -1 to 1
/// @param sin_radius  sine of the patch's angular radius, 0 (a point: the plain cosine) to 1 (half the
/// sphere)
/// @return in [0, 1]; cos_normal where no part is below the horizon, 0 where all of it is
/// Source: the integral of the cosine over the part above the horizon, in closed form: J. Snyder, "Area light
/// sources for real-time graphics", Microsoft MSR-TR-96-11 (1996). Checked against quadrature in the tests.
double cap_irradiance(double cos_normal, double sin_radius);

/// What a round patch of uniform radiance gives when it shines through a spot's profile, as a fraction of what a
/// receiver facing the patch gets from it without a profile; in [0, 1]. One integral over the angle to the
/// spot's axis, whose inner arc is in closed form; error below 1e-7.
/// @param normal     receiver's normal, unit
/// @param to_light   unit direction from the receiver to the center of the patch
/// @param to_spot    unit direction against the spot's axis: where a receiver on the axis sees the light
/// @param sin_radius sine of the patch's angular radius, above 0, at most 1
double cap_irradiance_through_spot(const SpotProfile& profile, const glm::dvec3& normal,
                                   const glm::dvec3& to_light, const glm::dvec3& to_spot, double sin_radius);

}  // namespace skinglow::detail
