#pragma once

#include <skinglow/angular_weight.h>

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "radiometry/area_angular_weight.h"
#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// What the vector kernels read of a light; which fields depends on the kernel.
struct KernelLight {
    enum class Kernel { sun, point, spot, rectangle, none };  // none: asked point by point

    Kernel kernel = Kernel::none;
    const PreparedLight* light = nullptr;
    glm::dvec3 strength{0.0};  ///< power * color
    glm::dvec3 position{0.0};
    glm::dvec3 reverse_axis{0.0};  ///< unit, against the direction of a sun, spot or rectangle
    double sin_sun_radius = 0.0;   ///< sun
    double radius_sq = 0.0;        ///< point and spot
    double softening_sq = 0.0;     ///< added to the squared distance
    double min_distance_sq = 0.0;
    double half_pi_radius = 0.0;  ///< spot
    double cos_edge = 0.0;
    double fade_scale = 0.0;      ///< 1 / width of the fading rim, in cosine
    double cos_uneven = 0.0;      ///< cosine of the angle beyond which the profile is not constant
    double cosine_falloff = 0.0;  ///< 1 where the profile has a cosine besides, else 0
    glm::dvec3 x_axis{0.0};       ///< rectangle
    glm::dvec3 y_axis{0.0};
    double half_x = 0.0;
    double half_y = 0.0;
};

/// Sums of irradiance over lights, vectorized over points: for rectangles without a spread, points, spots and suns.
/// The other lights, and points where a kernel's formula does not hold (a light that straddles the horizon, a
/// soft cone's rim, a point within the light), are asked of PreparedLight one by one.
class IrradianceSum {
  public:
    /// @param lights          have to outlive this; those that do not shine are left out
    /// @param angular_weight  none: every angle counts alike; has to outlive this
    /// @param tolerance       relative, of the integrals for ellipses and spreads
    IrradianceSum(std::span<const RigLight> lights, const AngularWeight* angular_weight, double tolerance);

    /// Adds the irradiance of all lights at each point to its sum, W/m^2.
    /// @param normals  as many, of any length; 0 receives nothing
    /// @param sums     as many; NaN for a point or normal that is not finite
    void add(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
             std::span<glm::dvec3> sums) const;

    /// For the kernels: adds one light at one point.
    /// @param unit_normal  0 receives nothing
    /// @param value   irradiance per unit of power; NaN: not known
    /// @param cosine  between the normal and the light's center; NaN: not known
    void add_one(const KernelLight& light, const glm::dvec3& point, const glm::dvec3& unit_normal,
                 double value, double cosine, glm::dvec3& sum) const;
    /// For the kernels: all lights at a point of any size.
    void add_one_by_one(std::span<const KernelLight> lights, const glm::dvec3& point,
                        const glm::dvec3& normal, glm::dvec3& sum) const;

    /// Lights of one kernel stand together.
    std::span<const KernelLight> lights() const { return lights_; }
    bool has_angular_weight() const { return angular_weight_ != nullptr; }

  private:
    std::vector<KernelLight> lights_;
    std::vector<std::optional<AreaAngularWeight>> area_weights_;  ///< one a light, of area lights
    const AngularWeight* angular_weight_;
    double tolerance_;
};

}  // namespace skinglow::detail
