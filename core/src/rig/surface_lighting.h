#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "light/light.h"
#include <skinglow/angular_weight.h>
#include <skinglow/environment.h>
#include "rig/light_bounds.h"
#include "rig/surface_term.h"

namespace skinglow {

struct SurfaceLightingOptions {
    std::size_t max_terms = 8;  ///< a material's work grows with them
    /// An area lamp is cut into tiles until each lamp's terms are this near to its irradiance, as a share of
    /// all the light, at the box's corners and middle; or until there are max_terms.
    double tolerance = 0.01;
};

/// The light on the far side of a skin in a form that a material works out at each pixel: a term for each
/// lamp that matters, and one polynomial in the normal for the world and all lamps beyond.
///
/// The brightest lamps get terms. What is beyond max_terms shines as if from far away, as nine spherical
/// harmonics about the box's middle (environment.h).
class SurfaceLighting {
  public:
    /// @param box  that holds the skin; @param environment, angular_weight  none: black, and every angle
    /// alike Throws std::invalid_argument on a bad lamp or box, a tolerance not above 0.
    SurfaceLighting(std::span<const Light> lights, const Box& box, const Environment* environment = nullptr,
                    const AngularWeight* angular_weight = nullptr,
                    const SurfaceLightingOptions& options = {});

    /// Plain ones first.
    const std::vector<SurfaceTerm>& terms() const { return terms_; }
    std::size_t plain_terms() const { return plain_terms_; }
    /// Index of the lamp that each term is of.
    const std::vector<std::size_t>& lights_of_terms() const { return lights_of_terms_; }
    /// Lamps that have no term: they are in the polynomial. Ascending.
    const std::vector<std::size_t>& far_lights() const { return far_lights_; }

    /// Irradiance along a unit normal n from the world and the far lamps: the sum of these nine times
    /// 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2, not below 0. All 0 where there is neither.
    const std::array<glm::dvec3, 9>& polynomial() const { return polynomial_; }
    const AngularCubic& angular() const { return angular_; }

    /// What the material shows at a place that faces along a unit normal, W/m^2, linear Rec.709.
    glm::dvec3 irradiance(const glm::dvec3& point, const glm::dvec3& normal) const;

  private:
    std::vector<SurfaceTerm> terms_;
    std::size_t plain_terms_ = 0;
    std::vector<std::size_t> lights_of_terms_;
    std::vector<std::size_t> far_lights_;
    std::array<glm::dvec3, 9> polynomial_{};
    AngularCubic angular_ = lambert_cubic;
};

}  // namespace skinglow
