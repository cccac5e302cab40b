#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include <skinglow/angular_weight.h>
#include "radiometry/prepared_light.h"

namespace skinglow {

/// A lamp, or a tile of one, as a formula so short that a renderer's material works it out at each pixel:
///
///     v = place - positional x,  q = |v|^2 + square,  l = v / |v|,  s = sqrt(square / q)
///     mu = n . l,  h = clamp(mu + s, 0, 2 s),  received = h^2 / (4 s) + max(mu - s, 0)
///     c = against_axis . l,  t = clamp(by_cosine c + constant + by_sine sqrt(1 - c^2), 0, 1)
///     profile = t (1 + smooth (t (3 - 2 t) - 1)) (1 + cosine (c - 1))
///     E = strength w(mu) received profile / q
///
/// for a place x that faces along n; w is an angular weight. Against `irradiance` it is exact for small
/// points and spots and sharp suns, for a soft point above the horizon, and far from everything else. What it
/// simplifies: the horizon through a wide lamp (a parabola for the exact segment), the blur of a soft spot's
/// rim, a ball's 1/d^2 over the object, an area lamp near by (as a disk on its axis, exact there).
struct SurfaceTerm {
    glm::dvec3 place{0.0};         ///< world; of a sun the unit direction towards it
    double positional = 1.0;       ///< 1, of a sun 0
    glm::dvec3 against_axis{0.0};  ///< unit, against the direction it shines to; 0 for a point
    double square = 0.0;           ///< of its radius
    glm::dvec3 strength{0.0};      ///< W (per m^2 at q = 1), linear Rec.709
    double smooth = 0.0;           ///< 1: the profile is a smooth step (spot), 0: straight
    double by_cosine = 0.0;
    double constant = 1.0;
    double by_sine = 0.0;
    double cosine = 0.0;  ///< 1: Blender 3.4's spot, which also falls by the cosine

    /// Whether it shines alike to all sides, so that a material needs no profile.
    bool is_plain() const { return by_cosine == 0.0 && by_sine == 0.0 && constant == 1.0 && cosine == 0.0; }

    /// E as above. @param normal  unit
    glm::dvec3 irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                          const AngularCubic& angular) const;
};

/// A lamp as terms: one, or for an area lamp columns x rows tiles (of an ellipse 1, 2, 4 or 8).
/// @param strength  power times color; @param middle  of the object, where a ball is exact
std::vector<SurfaceTerm> surface_terms(const PreparedLight& light, const glm::dvec3& strength,
                                       const glm::dvec3& middle, int columns = 1, int rows = 1);

}  // namespace skinglow
