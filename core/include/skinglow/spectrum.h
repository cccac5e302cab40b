#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

/// From spectra to linear Rec.709 and back, on the 5 nm grid of the CIE tables.
/// @code
/// const skinglow::Spectrum candle = skinglow::blackbody_spectrum(1900);
/// const glm::dvec3 color = skinglow::spectral_color(candle);  // linear Rec.709, luminance 1
/// @endcode
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
/// @param rgb  finite (negative parts make a spectrum that may be negative), else std::invalid_argument
Spectrum rgb_spectrum(const glm::dvec3& rgb);

/// Planck's law, relative to its largest sample (CODATA 2018: second radiation constant 1.438776877e-2 m K).
/// @param temperature_k  500 to 100000 K, else std::invalid_argument
Spectrum blackbody_spectrum(double temperature_k);

/// A light with one spectral line: a Gaussian of the given center and full width at half maximum, total power
/// 1. Narrower than the grid is allowed: the line is divided between its neighbors, as in tabulated_spectrum.
/// Throws std::invalid_argument.
/// @param center_nm  380 to 780
/// @param fwhm_nm  above 0 and at most 400
Spectrum line_spectrum(double center_nm, double fwhm_nm);

/// A measured light: power at ascending wavelengths, linear between them and 0 outside. Resampled to the grid
/// with its power kept: each piece is divided between the two samples around it, so that sums over the grid
/// are the integrals of the light against anything that is linear between samples. What lies outside 380 to
/// 780 nm is left out. Throws std::invalid_argument.
/// @param wavelength_nm  at least two, finite, ascending
/// @param power  as many, finite, 0 or more, not all 0 in the range
Spectrum tabulated_spectrum(std::span<const double> wavelength_nm, std::span<const double> power);

/// Linear Rec.709 of a light, scaled so that its luminance is 1; D65 is (1, 1, 1). May lie outside the gamut
/// (negative).
/// @param spectrum  finite, with a luminance above 0, else std::invalid_argument
glm::dvec3 spectral_color(const Spectrum& spectrum);

/// Linear Rec.709 of the light behind a filter, on the scale of the light's own luminance 1: the full
/// spectral answer, the reference for every computation in RGB. Throws std::invalid_argument.
/// @param spectrum  finite, with a luminance above 0
/// @param transmittance  of the filter, one per sample, finite
glm::dvec3 spectral_color(const Spectrum& spectrum, const Spectrum& transmittance);

/// A filter as it acts on linear Rec.709 light that has the spectrum of rgb_spectrum: the 3x3 matrix that is
/// linear in the transmittance. A filter of 1 is the identity, exactly to rounding.
/// @param transmittance  one per sample
glm::dmat3 transmission_matrix(std::span<const double, spectral_samples> transmittance);

/// Rec.709 luminance Y of a linear color (ITU-R BT.709-6, item 3.2 of part 1).
double luminance(const glm::dvec3& linear_rgb);

}  // namespace skinglow
