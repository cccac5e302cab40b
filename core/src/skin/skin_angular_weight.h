#pragma once

#include <skinglow/angular_weight.h>
#include "skin/tissue.h"

namespace skinglow {

/// Where the angular weight of each channel is solved: the dominant wavelengths of the Rec.709 primaries, nm
/// (of their chromaticities in ITU-R BT.709-6 against D65, by the CIE 1931 observer).
constexpr std::array<double, 3> primary_wavelengths_nm = {611.4, 549.1, 464.2};

/// How the light that strikes a skin's far side enters by its angle: w(mu) = T(mu) / T_diffuse from the
/// layered transport solution. It hardly depends on the thickness: light that was scattered often has
/// forgotten where it came from (docs/accuracy.md has the figures).
/// @param thickness_mm  typical of the object, above 0; @param streams  as for solve_slab
/// Throws std::invalid_argument naming what is not allowed.
AngularWeight skin_angular_weight(const Tissue& tissue, double thickness_mm = 4.0, int streams = 16);

}  // namespace skinglow
