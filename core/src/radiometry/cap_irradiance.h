#pragma once

#include "numerics/detail.h"

namespace skinglow::detail {

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

}  // namespace skinglow::detail
