#pragma once

#include <skinglow/light.h>

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "geometry/vector.h"
#include "numerics/detail.h"
#include "radiometry/area_irradiance.h"
#include "radiometry/cap_irradiance.h"

namespace skinglow::detail {

/// No light is nearer than this, in the unit of length of the scene: a point at the position of a light gets what it gets
/// at this distance, facing it, so that nothing is infinite.
constexpr double min_light_distance = 1e-6;

/// A light without its color and power, its angles and frames computed once: how much of a unit of power
/// arrives. All values are in 1/m^2 (1 for a sun, whose power is W/m^2 already), 0 or more, and finite.
class PreparedLight {
  public:
    explicit PreparedLight(const Light& light);

    /// Irradiance per unit of power at a point whose surface faces along `normal` (unit), with the cosine and
    /// the horizon.
    /// @param tolerance  relative error of the integrals for ellipses and spreads
    double irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const;

    /// The same for a surface that faces the center of the light: no cosine but the light's own.
    double facing_irradiance(const glm::dvec3& point, double tolerance) const;

    /// Unit direction from the point to the center of the light; against its axis where the point is there.
    glm::dvec3 to_light(const glm::dvec3& point) const;
    /// Distance to the center of the light, 0 for a sun.
    double distance(const glm::dvec3& point) const;

    LightKind kind() const { return kind_; }
    const glm::dvec3& position() const { return position_; }
    const glm::dvec3& direction() const { return frame_[2]; }
    /// Of the ball that holds all that glows; 0 for a sun.
    double radius() const { return radius_; }
    bool soft_falloff() const { return soft_falloff_; }
    double sin_sun_radius() const { return sin_sun_radius_; }
    const std::optional<SpotProfile>& spot() const { return spot_; }
    /// The area light in units of `area_scale`.
    const std::optional<AreaEmitter>& area() const { return area_; }
    double area_scale() const { return area_scale_; }
    /// World point of an area light: x and y from -1 to 1 along its half axes.
    glm::dvec3 point_on_area(double x, double y) const;
    bool dark() const { return dark_; }
    /// Columns: the light's x (along its tangent), y, and z (where it shines to), unit.
    const glm::dmat3& frame() const { return frame_; }

    /// Point and spot: what a facing receiver gets per unit of power, and the sine of the angular radius of
    /// the light.
    struct BallTerm {
        double facing;
        double sin_radius;
        bool inside;  ///< within a ball light shines from everywhere
    };
    BallTerm ball_term(double distance) const;

  private:
    double ball_irradiance(const glm::dvec3& point, const glm::dvec3& normal) const;
    double through_spot(const BallTerm& ball, const glm::dvec3& normal, const glm::dvec3& to_light) const;
    double area_irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const;

    LightKind kind_;
    glm::dvec3 position_;
    glm::dmat3 frame_{1.0};
    double radius_ = 0;
    bool soft_falloff_ = true;
    double sin_sun_radius_ = 0;
    std::optional<SpotProfile> spot_;
    std::optional<AreaEmitter> area_;  ///< in units of area_scale_, so that no size over- or underflows
    double area_scale_ = 1;
    bool dark_ = false;  ///< a cone, spread or area of no width
};

/// A light of a rig, ready for every query.
struct RigLight {
    std::size_t index;  ///< in the list of lights
    PreparedLight light;
    glm::dvec3 color;
    double power;
    bool shines;  ///< on, and its cone, spread or area has a width

    /// Irradiance from what a unit of power gives. One factor for all channels: a black channel stays
    /// exactly black.
    glm::dvec3 scaled(double per_power) const { return color * (power * per_power); }
    glm::dvec3 strength() const { return color * power; }
};

}  // namespace skinglow::detail
