#pragma once

#include <skinglow/tissue.h>

#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// The media of one skin at some wavelengths, computed once from a tissue that is checked once.
struct SkinOptics {
    std::vector<SkinMedia> media;  ///< per wavelength

    /// Throws std::invalid_argument.
    /// @param tissue in range
    /// @param wavelength_nm each 380 to 780
    SkinOptics(const Tissue& tissue, std::span<const double> wavelength_nm);
};

}  // namespace skinglow::detail
