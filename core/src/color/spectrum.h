#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

/// From spectra to linear Rec.709 and back, on the 5 nm grid of the CIE tables (core/color/spectral_data).
namespace skinglow {

constexpr std::size_t spectral_samples = 81;
constexpr double first_sample_nm = 380.0;
constexpr double sample_step_nm = 5.0;

/// Wavelength of sample k, nm: 380, 385, ... 780.
constexpr double sample_wavelength_nm(std::size_t k) {
    return first_sample_nm + sample_step_nm * static_cast<double>(k);
}

/// One number at each sample: relative power per nm, or a transmittance.
using Spectrum = std::array<double, spectral_samples>;

/// CIE D65 (ISO/CIE 11664-2), 100 at 560 nm: the light that is linear Rec.709 (1, 1, 1).
const Spectrum& d65_spectrum();

/// The light that stands for linear Rec.709 (r, g, b): D65 * (r * red + g * green + b * blue), with the basis
/// of I. Mallett and C. Yuksel, "Spectral Primary Decomposition for Rendering with sRGB Reflectance" (2019).
/// Linear in rgb, and spectral_color gives rgb back, scaled to luminance 1.
/// @param rgb finite (negative parts make a spectrum that may be negative), else std::invalid_argument
Spectrum rgb_spectrum(const glm::dvec3& rgb);

/// Planck's law, relative to its largest sample (CODATA 2018: second radiation constant 1.438776877e-2 m K).
/// @param temperature_k 500 to 100000 K, else std::invalid_argument
Spectrum blackbody_spectrum(double temperature_k);

/// A lamp with one line: a Gaussian of the given center and full width at half maximum, total power 1.
/// Narrower than the grid is allowed: the line is shared between its neighbors, as in tabulated_spectrum.
/// @param center_nm 380 to 780; @param fwhm_nm above 0 and at most 400. Else std::invalid_argument.
Spectrum line_spectrum(double center_nm, double fwhm_nm);

/// A measured lamp: power at ascending wavelengths, straight between them and 0 outside. Carried to the grid
/// with its power kept: each piece is shared between the two samples around it, so that sums over the grid
/// are the integrals of the lamp against anything that runs straight between samples. What lies outside 380
/// to 780 nm is left out.
/// @param wavelength_nm at least two, finite, ascending; @param power as many, finite, 0 or more, not all 0
/// in the range.
Spectrum tabulated_spectrum(std::span<const double> wavelength_nm, std::span<const double> power);

/// Linear Rec.709 of a lamp, scaled so that its luminance is 1; D65 is (1, 1, 1). May lie outside the gamut
/// (negative).
/// @param spectrum finite, with a luminance above 0, else std::invalid_argument
glm::dvec3 spectral_color(const Spectrum& spectrum);

/// Linear Rec.709 of the lamp's light behind a filter, on the scale of the lamp's own luminance 1: the full
/// spectral answer, the reference for every RGB route.
/// @param transmittance one per sample, finite, else std::invalid_argument
glm::dvec3 spectral_color(const Spectrum& spectrum, const Spectrum& transmittance);

/// A filter as it acts on linear Rec.709 light carried by rgb_spectrum: the 3x3 matrix sum over samples of
/// matrix_weights()[k] * transmittance[k]. A filter of 1 is the identity, exactly to rounding.
glm::dmat3 transmission_matrix(const Spectrum& transmittance);

/// The matrix that each sample adds per transmittance: color of the sample (rows) times what D65 times each
/// basis spectrum brings there (columns).
const std::array<glm::dmat3, spectral_samples>& matrix_weights();

}  // namespace skinglow
