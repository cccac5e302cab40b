#pragma once

#include <span>
#include <vector>

#include "skin/tissue.h"
#include "slab/slab_solver.h"
#include "slab/thickness_curve.h"

namespace skinglow {

/// Total transmittance of one skin at one wavelength, for any number of thicknesses: the eigenproblems are
/// solved once, here, and serve them all.
class SkinCurve {
  public:
    /// @param wavelength_nm 380 to 780; @param streams as for solve_slab. Throws std::invalid_argument.
    SkinCurve(const Tissue& tissue, double wavelength_nm, Incidence incidence, int streams);

    /// @param total_thickness_mm epidermes included, finite, 0 or more, in any order; shared out as
    /// share_thickness does.
    /// @param out as many, each in [0, 1]. At thickness 0 the two surfaces still reflect.
    void transmittance(std::span<const double> total_thickness_mm, std::span<double> out) const;

  private:
    Tissue tissue_;
    SkinMedia media_;
    Incidence incidence_;
    int streams_;
    ThicknessCurve thick_;
};

/// Transmittance of skin, row by row: out[i * wavelengths + j] at thickness i and wavelength j.
/// Continuous and falling with thickness.
std::vector<double> transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                  std::span<const double> wavelength_nm,
                                  Incidence incidence = Incidence::diffuse(), int streams = 16);

}  // namespace skinglow
