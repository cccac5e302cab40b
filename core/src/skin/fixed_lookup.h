#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "skin/base_lut.h"

namespace skinglow {

/// The existing method, the one to beat: light through skin of thickness d by the six-Gaussian skin profile,
/// linear Rec.709, one color per entry of the axis, white at d = 0 to the three digits of its weights. It is
/// reddish and knows no lamp.
///
/// T(d) = sum_i w_i exp(-d^2 / v_i), with variances v_i and weights w_i of E. d'Eon and D. Luebke, "Advanced
/// Techniques for Realistic Real-Time Skin Rendering", GPU Gems 3 (2007), ch. 14, in the form in which
/// real-time shaders use the profile for translucency (J. Jimenez et al., "Real-Time Realistic Skin
/// Translucency", IEEE CG&A 30(4), 2010).
std::vector<glm::dvec3> six_gaussian_lookup(const LutAxis& axis);

/// The paper's base lookup `BLL` when none is given: the brightness (Rec.709 luminance) of the existing
/// lookup.
BaseLut six_gaussian_base(const LutAxis& axis);

}  // namespace skinglow
