#pragma once

#include <cstddef>
#include <vector>

#include "skin/base_lut.h"
#include "skin/tissue.h"

namespace skinglow {

/// What skin_lut chose, and how far off it thinks it is.
///
/// Every error is in one norm. At each entry and for each primary (column j of M) it is the largest
/// difference in column j over the largest number of column j, or over 1e-6 where skin lets even less
/// through:
///     max over entries and j of  max_i |M_ij - exact_ij| / max(max_i |exact_ij|, 1e-6).
/// So deep red skin has as many right digits as thin skin, and so has the little that a blue lamp brings
/// through. Exact means: every wavelength of the 5 nm grid, every thickness solved, streams without end.
struct SkinLutReport {
    int streams = 0;
    std::vector<double>
        thickness_nodes_mm;  ///< where transmittance was solved; between, ln T runs along a monotone cubic
    std::vector<double>
        wavelengths_nm;             ///< where it was solved; between, diffusion theory corrected from these
    std::size_t pairs_solved = 0;   ///< wavelength and thickness
    std::size_t pairs_skipped = 0;  ///< left out as too dark to matter, of all nodes times 81 wavelengths
    double stream_error = 0.0;
    double node_error = 0.0;
    double wavelength_error = 0.0;
    double estimated_error = 0.0;  ///< bound on the error by the three together
};

/// What is solved for a table.
struct SkinLutPlan {
    int streams = 16;                 ///< per hemisphere, even
    std::size_t nodes = 17;           ///< thicknesses in each of the two stretches, odd, 5 or more
    std::size_t wavelength_step = 4;  ///< every how many samples of the 5 nm grid: 1, 2, 4 or 8
};

struct SkinLut {
    BaseLut lut;
    SkinLutReport report;
};

constexpr double min_lut_tolerance = 1e-6;
constexpr double max_lut_tolerance = 0.1;

/// The base lookup table of mode `physical`: M(d), the light that leaves skin d thick lit diffusely from
/// behind (exitance over irradiance, linear Rec.709 to linear Rec.709), from the layered transport solution.
/// The coarsest streams, thickness nodes and wavelengths that meet the tolerance are chosen from estimates
/// made on the way. At d = 0 two bare surfaces are left, which still reflect: M(0) is below the identity.
/// @param size and max_thickness_mm as for LutAxis
/// @param tolerance largest error, in SkinLutReport's norm, 1e-6 to 0.1. Else std::invalid_argument.
SkinLut skin_lut(const Tissue& tissue, std::size_t size = 256, double max_thickness_mm = 12.0,
                 double tolerance = 1e-3);

/// The same with everything chosen by the caller; the report says what it came to.
SkinLut skin_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, const SkinLutPlan& plan);

/// skin_lut without the report.
BaseLut base_lut(const Tissue& tissue, std::size_t size = 256, double max_thickness_mm = 12.0,
                 double tolerance = 1e-3);

/// The same table by brute force, nothing left out: all 81 wavelengths at every entry. What skin_lut is
/// measured by.
BaseLut reference_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, int streams);

/// The error of `lut` against `exact` in SkinLutReport's norm; tables of one size.
double lut_error(const BaseLut& lut, const BaseLut& exact);

}  // namespace skinglow
