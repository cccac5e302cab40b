#pragma once

#include "numerics/detail.h"

namespace skinglow::detail {

/// Fresnel's reflectance of unpolarized light that meets a smooth surface.
/// @param n_from  refractive index of the side that it comes from, 1 or more
/// @param n_to    of the other side
/// @param cosine  to the normal, on the side that it comes from, [0, 1]
double fresnel_reflectance(double n_from, double n_to, double cosine);

/// What a surface does to diffuse light.
struct DiffuseReflectance {
    double outside;  ///< of light that comes from outside
    double inside;   ///< of light that comes from inside
};

/// Of a smooth surface of a body of refractive index n in air; the two are tied by reciprocity,
/// 1 - outside = n^2 (1 - inside).
DiffuseReflectance diffuse_reflectance(double refractive_index);

}  // namespace skinglow::detail
