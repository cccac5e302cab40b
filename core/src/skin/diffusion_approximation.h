#pragma once

#include <span>
#include <vector>

#include "skin/tissue.h"

namespace skinglow {

/// Skin lit diffusely, by the diffusion approximation (P1) with partly reflecting surfaces, layer by layer: a
/// closed form, 30 ns a thickness, some per cent off deep in skin and tens of per cent in thin skin
/// (docs/accuracy.md). base_lut uses it to fill in between the wavelengths that it solves properly, and to
/// see what cannot matter.
///
/// In each layer the fluence obeys D f'' = mua f; fluence and flux are continuous, and at each
/// surface the partial currents f/4 +- F/2 are joined by the diffuse Fresnel reflectance (e.g. A. Ishimaru,
/// "Wave Propagation and Scattering in Random Media", 1978, ch. 9).
class DiffusionCurve {
  public:
    /// Which coefficient of diffusion.
    enum class Coefficient {
        classic,     ///< D = 1 / (3 (mua + mus')), P1: light falls off too fast where it is absorbed
        asymptotic,  ///< D = mua / k^2 with k the slowest decay rate of P3 (E. L. Hull, T. H. Foster, JOSA A
                     ///< 18:584, 2001)
    };

    /// @param wavelength_nm 380 to 780, else std::invalid_argument
    DiffusionCurve(const Tissue& tissue, double wavelength_nm, Coefficient coefficient);

    /// Natural logarithm of the transmittance, total thickness in mm, finite, 0 or more (not checked).
    double log_transmittance(double total_thickness_mm) const;

  private:
    /// ln T = log_scale - k d - log1p(mirror * exp(-2 k d)) for a layer d thick between whatever is around
    /// it.
    struct Form {
        double log_scale, k, mirror;
        double at(double thickness) const;
    };
    double epidermes_mm_;  // both together
    Form thick_;           // of the inner layer between two epidermes
    Form thin_;            // of epidermis alone
};

/// Transmittance of skin by DiffusionCurve, row by row: out[i * wavelengths + j] at thickness i and
/// wavelength j. Arguments and errors as for `transmittance`.
std::vector<double> diffusion_transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                            std::span<const double> wavelength_nm);

/// Reflectance of a smooth surface for diffuse light from outside, Fresnel's formulae integrated over the
/// hemisphere.
/// @param refractive_index 1 or more
double diffuse_fresnel_reflectance(double refractive_index);

}  // namespace skinglow
