#include <skinglow/spectrum.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "spectral_tables.h"

namespace skinglow {
namespace {

static_assert(std::size(tables::color_matching) == spectral_samples);
static_assert(std::size(tables::d65) == spectral_samples);
static_assert(std::size(tables::srgb_basis) == spectral_samples);
static_assert(tables::color_matching[0][0] == first_sample_nm && tables::d65[0][0] == first_sample_nm &&
              tables::srgb_basis[0][0] == first_sample_nm);
static_assert(tables::d65[1][0] == first_sample_nm + sample_step_nm);

glm::dvec3 columns(const double* row) {
    return {row[1], row[2], row[3]};
}
glm::dvec3 color_matching(std::size_t k) {
    return columns(tables::color_matching[k]);
}
glm::dvec3 basis(std::size_t k) {
    return columns(tables::srgb_basis[k]);
}

glm::dvec3 tristimulus(const Spectrum& spectrum) {
    glm::dvec3 xyz(0.0);
    for (std::size_t k = 0; k < spectral_samples; ++k) xyz += spectrum[k] * color_matching(k);
    return xyz;
}

/// XYZ to linear Rec.709 from the chromaticities of ITU-R BT.709-6, item 1.3, with D65 as tabulated for
/// white.
glm::dmat3 rec709_from_xyz() {
    constexpr double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    glm::dmat3 primaries(0.0);
    for (int j = 0; j < 3; ++j)
        primaries[j] = {xy[j][0] / xy[j][1], 1.0, (1.0 - xy[j][0] - xy[j][1]) / xy[j][1]};
    const glm::dvec3 white = tristimulus(d65_spectrum());
    const glm::dvec3 luminances = glm::inverse(primaries) * white / white.y;
    for (int j = 0; j < 3; ++j) primaries[j] *= luminances[j];
    return glm::inverse(primaries);
}

/// The linear Rec.709 color of power 1 at each sample, for sums over samples.
const std::array<glm::dvec3, spectral_samples>& sample_colors() {
    static const auto colors = [] {
        const glm::dmat3 from_xyz = rec709_from_xyz();
        std::array<glm::dvec3, spectral_samples> result{};
        glm::dmat3 primaries(0.0);  // the colors that the basis spectra under D65 have by the tables
        for (std::size_t k = 0; k < spectral_samples; ++k) {
            result[k] = from_xyz * color_matching(k);
            primaries += glm::outerProduct(result[k], d65_spectrum()[k] * basis(k));
        }
        // By the tables the primaries miss (1,0,0), (0,1,0), (0,0,1) by up to 1e-4, being rounded and
        // sampled. The colors are turned by that much, so that skin of transmittance 1 changes no light at
        // all.
        const glm::dmat3 exact = glm::inverse(primaries);
        for (glm::dvec3& color : result) color = exact * color;
        return result;
    }();
    return colors;
}

auto sample_name(const char* quantity, std::size_t k) {
    return [=] { return std::string(quantity) + " at " + to_text(sample_wavelength_nm(k)) + " nm"; };
}

double luminance_of(const Spectrum& spectrum) {
    double luminance = 0.0;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        require_finite(sample_name("power", k), spectrum[k]);
        luminance += spectrum[k] * color_matching(k).y;
    }
    if (!(luminance > 0.0 && std::isfinite(luminance))) {
        refuse_argument("luminance of the spectrum", to_text(luminance), "finite and above 0");
    }
    return luminance;
}

/// Of colors whose D65 is (1,1,1), the factor that scales a light of this luminance sum to luminance 1.
double scale_to_unit_luminance(double luminance) {
    static const double white = tristimulus(d65_spectrum()).y;
    return white / luminance;
}

/// Divides the power of one linear piece from (x0, p0) to (x1, p1), inside one interval of the grid, between
/// the interval's ends.
void add_piece(double x0, double p0, double x1, double p1, Spectrum& out) {
    const double center = 0.5 * (x0 + x1);
    const double sample = (center - first_sample_nm) / sample_step_nm;
    if (!(sample >= 0.0 && sample <= static_cast<double>(spectral_samples - 1))) return;
    const auto k = std::min(static_cast<std::size_t>(sample), spectral_samples - 2);
    // Simpson's rule is exact for a linear power times a linear weight.
    const auto weight = [&](double x) { return (x - sample_wavelength_nm(k)) / sample_step_nm; };
    const double power = 0.5 * (p0 + p1);
    const double right = (p0 * weight(x0) + 4.0 * power * weight(center) + p1 * weight(x1)) / 6.0;
    const double per_sample = (x1 - x0) / sample_step_nm;
    out[k] += per_sample * (power - right);
    out[k + 1] += per_sample * right;
}

/// The matrix that each sample adds per transmittance: color of the sample (rows) times what D65 times each
/// basis spectrum brings there (columns).
const std::array<glm::dmat3, spectral_samples>& matrix_weights() {
    static const auto weights = [] {
        std::array<glm::dmat3, spectral_samples> result{};
        for (std::size_t k = 0; k < spectral_samples; ++k) {
            result[k] = glm::outerProduct(sample_colors()[k], d65_spectrum()[k] * basis(k));
        }
        return result;
    }();
    return weights;
}

}  // namespace

const Spectrum& d65_spectrum() {
    static const Spectrum spectrum = [] {
        Spectrum result{};
        for (std::size_t k = 0; k < spectral_samples; ++k) result[k] = tables::d65[k][1];
        return result;
    }();
    return spectrum;
}

Spectrum rgb_spectrum(const glm::dvec3& rgb) {
    require_finite("rgb", rgb);
    Spectrum result{};
    for (std::size_t k = 0; k < spectral_samples; ++k)
        result[k] = d65_spectrum()[k] * glm::dot(rgb, basis(k));
    return result;
}

Spectrum blackbody_spectrum(double temperature_k) {
    require_between("temperature_k", temperature_k, 500, 100000, " K");
    constexpr double second_radiation_nm_k = 1.438776877e7;  // h c / k, CODATA 2018, in nm K
    Spectrum result{};
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        const double nm = sample_wavelength_nm(k);
        result[k] =
            1.0 / (std::pow(nm / 560.0, 5.0) * std::expm1(second_radiation_nm_k / (nm * temperature_k)));
    }
    const double largest = *std::max_element(result.begin(), result.end());
    for (double& power : result) power /= largest;
    return result;
}

Spectrum line_spectrum(double center_nm, double fwhm_nm) {
    require_between("center_nm", center_nm, 380, 780, " nm");
    if (!(fwhm_nm > 0.0 && fwhm_nm <= 400.0))
        refuse_argument("fwhm_nm", to_text(fwhm_nm), "above 0 and at most 400 nm");
    constexpr int pieces_per_fwhm = 32;
    constexpr int extent = 3;  // widths either side: what is left out is 2e-12 of the line
    std::vector<double> nm;
    std::vector<double> power;
    for (int i = -extent * pieces_per_fwhm; i <= extent * pieces_per_fwhm; ++i) {
        const double widths = static_cast<double>(i) / pieces_per_fwhm;
        nm.push_back(center_nm + fwhm_nm * widths);
        power.push_back(std::exp2(-4.0 * widths * widths) / fwhm_nm);
    }
    Spectrum result = tabulated_spectrum(nm, power);
    double total = 0.0;
    for (const double value : result) total += value;
    for (double& value : result) value /= total;
    return result;
}

Spectrum tabulated_spectrum(std::span<const double> wavelength_nm, std::span<const double> power) {
    if (wavelength_nm.size() < 2 || power.size() != wavelength_nm.size()) {
        refuse_argument("tabulated spectrum",
                        "of " + std::to_string(wavelength_nm.size()) + " wavelengths and " +
                            std::to_string(power.size()) + " powers",
                        "two or more wavelengths and as many powers");
    }
    for (std::size_t i = 0; i < power.size(); ++i) {
        require_finite(entry_name("wavelength_nm", i), wavelength_nm[i]);
        require_not_negative(entry_name("power", i), power[i]);
        if (i > 0 && !(wavelength_nm[i] > wavelength_nm[i - 1])) {
            refuse_value(entry_name("wavelength_nm", i), wavelength_nm[i], "more than the one before it");
        }
    }
    Spectrum result{};
    for (std::size_t i = 0; i + 1 < power.size(); ++i) {
        const double start = std::max(wavelength_nm[i], first_sample_nm);
        const double end = std::min(wavelength_nm[i + 1], sample_wavelength_nm(spectral_samples - 1));
        const double slope = (power[i + 1] - power[i]) / (wavelength_nm[i + 1] - wavelength_nm[i]);
        const auto at = [&](double x) { return power[i] + slope * (x - wavelength_nm[i]); };
        for (double from = start; from < end;) {
            const double next =
                first_sample_nm +
                sample_step_nm * (std::floor((from - first_sample_nm) / sample_step_nm) + 1.0);
            const double to = std::min(next, end);
            add_piece(from, at(from), to, at(to), result);
            from = to;
        }
    }
    if (std::all_of(result.begin(), result.end(), [](double value) { return value == 0.0; })) {
        refuse_argument("power of the tabulated spectrum", "0", "above 0 somewhere from 380 to 780 nm");
    }
    return result;
}

glm::dvec3 spectral_color(const Spectrum& spectrum) {
    Spectrum clear{};
    clear.fill(1.0);
    return spectral_color(spectrum, clear);
}

glm::dvec3 spectral_color(const Spectrum& spectrum, const Spectrum& transmittance) {
    const double scale = scale_to_unit_luminance(luminance_of(spectrum));
    glm::dvec3 color(0.0);
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        require_finite(sample_name("transmittance", k), transmittance[k]);
        color += spectrum[k] * transmittance[k] * scale * sample_colors()[k];
    }
    return require_finite("color of the spectrum", color);
}

glm::dmat3 transmission_matrix(std::span<const double, spectral_samples> transmittance) {
    glm::dmat3 matrix(0.0);
    const auto& weights = matrix_weights();
    for (std::size_t k = 0; k < spectral_samples; ++k) matrix += weights[k] * transmittance[k];
    return matrix;
}

double luminance(const glm::dvec3& linear_rgb) {
    return glm::dot(linear_rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace skinglow
