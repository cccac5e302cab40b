#pragma once

#include <skinglow/spectrum.h>
#include <skinglow/tissue.h>

#include "numerics/detail.h"

namespace skinglow::detail {

/// What skin too thick to let light through sends back of diffuse light, by wavelength: by the layered
/// transport solution (slab.h), without the light that the surface throws back. Throws std::invalid_argument.
Spectrum thick_skin(const Tissue& tissue);

}  // namespace skinglow::detail
