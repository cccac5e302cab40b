#pragma once

#include <skinglow/angular_weight.h>
#include <skinglow/box.h>
#include <skinglow/environment.h>
#include <skinglow/rig.h>

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

/// The light on the far side of a skin in a form that a material works out at each pixel.
/// @code
/// const skinglow::SurfaceLighting lighting(rig, skinglow::box_of(vertices), {.max_terms = 4});
/// const glm::dvec3 shown = lighting.irradiance(point, normal);
/// @endcode
namespace skinglow {

/// A light, or a tile of one, as a formula so short that a renderer's material works it out at each pixel:
///
///     v = position - is_positional x,  q = |v|^2 + radius_sq,  l = v / |v|,  s = sqrt(radius_sq / q)
///     mu = n . l,  h = clamp(mu + s, 0, 2 s),  received = h^2 / (4 s) + max(mu - s, 0)
///     c = reverse_axis . l,  t = clamp(cos_scale c + bias + sin_scale sqrt(1 - c^2), 0, 1)
///     profile = t (1 + smoothstep (t (3 - 2 t) - 1)) (1 + cosine_falloff (c - 1))
///     E = strength w(mu) received profile / q
///
/// for a point x that faces along n; w is an angular weight. Against `irradiance_at` it is exact for small
/// points and spots and sharp suns, for a soft point above the horizon, and far from everything else. What it
/// simplifies: the horizon through a wide light (a parabola for the exact segment), the blur of a soft spot's
/// rim, a ball's 1/d^2 over the object, an area light near by (as a disk on its axis, exact there).
struct SurfaceTerm {
    glm::dvec3 position{0.0};      ///< world; of a sun the unit direction to it
    double is_positional = 1.0;    ///< 1, of a sun 0
    glm::dvec3 reverse_axis{0.0};  ///< unit, against the direction it shines to; 0 for a point
    double radius_sq = 0.0;        ///< squared radius
    glm::dvec3 strength{0.0};      ///< W (per m^2 at q = 1), linear Rec.709
    double smoothstep = 0.0;       ///< 1: the profile is a smoothstep (spot), 0: linear
    double cos_scale = 0.0;
    double bias = 1.0;
    double sin_scale = 0.0;
    double cosine_falloff = 0.0;  ///< 1: Blender 3.4's spot, which also falls by the cosine

    /// Whether it shines alike to all sides, so that a material needs no profile.
    bool is_plain() const {
        return cos_scale == 0.0 && sin_scale == 0.0 && bias == 1.0 && cosine_falloff == 0.0;
    }

    /// E as above.
    /// @param point    x, world
    /// @param normal   n, unit
    /// @param angular  w
    glm::dvec3 irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                          const AngularCubic& angular) const;
};

struct SurfaceLightingOptions {
    std::size_t max_terms = 8;  ///< shader cost is linear in this
    /// An area light is cut into tiles until each light's terms are this near to its irradiance, as a
    /// fraction of all the light, at the box's corners and center; or until there are max_terms.
    double tolerance = 0.01;
    const Environment* environment = nullptr;       ///< none: black
    const AngularWeight* angular_weight = nullptr;  ///< none: every angle enters alike
};

/// A term for each light that matters, the brightest first, and one polynomial in the normal for the world and
/// all lights beyond max_terms, which shine as if from far away: nine spherical harmonics about the box's
/// center.
class SurfaceLighting {
  public:
    /// @param box  that holds the skin, world
    /// Throws std::invalid_argument on a bad box or a tolerance not above 0.
    SurfaceLighting(const PreparedRig& rig, const Box& box, const SurfaceLightingOptions& options = {});

    /// Plain ones first.
    const std::vector<SurfaceTerm>& terms() const { return terms_; }
    std::size_t plain_terms() const { return plain_terms_; }
    /// Index of the light that each term is of.
    const std::vector<std::size_t>& lights_of_terms() const { return lights_of_terms_; }
    /// Lights that have no term: they are in the polynomial. Ascending.
    const std::vector<std::size_t>& far_lights() const { return far_lights_; }

    /// Irradiance along a unit normal n from the world and the far lights: the sum of these nine times
    /// 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2. Negative where far lights take light away; only the sum
    /// with the terms is not below 0. All 0 where there is neither.
    const std::array<glm::dvec3, 9>& polynomial() const { return polynomial_; }
    const AngularCubic& angular() const { return angular_; }

    /// What the material shows: polynomial and terms, not below 0. W/m^2, linear Rec.709.
    /// @param point   world, finite
    /// @param normal  unit
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
