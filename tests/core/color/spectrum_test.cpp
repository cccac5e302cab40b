#include <gtest/gtest.h>
#include <skinglow/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace skinglow {
namespace {

Spectrum flat(double value) {
    Spectrum result{};
    result.fill(value);
    return result;
}

void expect_color(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "channel " << i;
}

TEST(Spectrum, FilterOfOneIsTheIdentity) {
    const glm::dmat3 matrix = transmission_matrix(flat(1.0));
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(matrix[j][i], i == j ? 1.0 : 0.0, 1e-14);
    }
}

TEST(Spectrum, TableIsTurnedByNoMoreThanItsOwnRounding) {
    // Independent of the library's own correction: the standard's matrix (IEC 61966-2-1, four digits) on the
    // tables.
    const glm::dvec3 x(3.2406, -0.9689, 0.0557), y(-1.5372, 1.8758, -0.2040), z(-0.4986, 0.0415, 1.0570);
    // Known XYZ of D65, 2 degrees, 5 nm: 95.047, 100, 108.883 (ASTM E308).
    expect_color(0.95047 * x + y + 1.08883 * z, glm::dvec3(1.0), 3e-4);
    expect_color(spectral_color(d65_spectrum()), glm::dvec3(1.0), 1e-6);
}

TEST(Spectrum, RgbGoesToASpectrumAndBack) {
    for (const glm::dvec3 rgb : {glm::dvec3(1, 1, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0),
                                 glm::dvec3(0, 0, 1), glm::dvec3(0.9, 0.2, 0.05)}) {
        const glm::dvec3 back = spectral_color(rgb_spectrum(rgb));
        const double scale = back.x + back.y + back.z;
        expect_color(back / scale, rgb / (rgb.x + rgb.y + rgb.z), 1e-12);
        EXPECT_NEAR(0.2126 * back.x + 0.7152 * back.y + 0.0722 * back.z, 1.0, 5e-4);
    }
}

TEST(Spectrum, MatrixIsTheFullSpectralAnswerForLightsOfTheBasis) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 50; ++trial) {
        Spectrum filter{};
        for (double& value : filter) value = uniform(random);
        const glm::dvec3 rgb(uniform(random), uniform(random), uniform(random));
        const glm::dvec3 clear = spectral_color(rgb_spectrum(rgb));
        const glm::dvec3 full = spectral_color(rgb_spectrum(rgb), filter);
        expect_color(transmission_matrix(filter) * clear, full, 1e-12);
    }
}

TEST(Spectrum, BlackBodiesHaveTheirKnownColor) {
    // CIE 1931 chromaticity of the Planckian locus (Wyszecki and Stiles 1982, table 1(3.11)): 2700 K, 6500 K.
    const auto chromaticity = [](const glm::dvec3& rgb) {
        const glm::dvec3 xyz = rgb.x * glm::dvec3(0.4124564, 0.2126729, 0.0193339) +
                               rgb.y * glm::dvec3(0.3575761, 0.7151522, 0.1191920) +
                               rgb.z * glm::dvec3(0.1804375, 0.0721750, 0.9503041);
        return glm::dvec2(xyz.x, xyz.y) / (xyz.x + xyz.y + xyz.z);
    };
    const glm::dvec2 warm = chromaticity(spectral_color(blackbody_spectrum(2700.0)));
    const glm::dvec2 cool = chromaticity(spectral_color(blackbody_spectrum(6500.0)));
    EXPECT_NEAR(warm.x, 0.4599, 5e-4);
    EXPECT_NEAR(warm.y, 0.4106, 5e-4);
    EXPECT_NEAR(cool.x, 0.3135, 5e-4);
    EXPECT_NEAR(cool.y, 0.3237, 5e-4);
}

TEST(Spectrum, BlackBodyPeaksWhereWienSays) {
    const Spectrum spectrum = blackbody_spectrum(5000.0);
    const auto peak =
        static_cast<std::size_t>(std::max_element(spectrum.begin(), spectrum.end()) - spectrum.begin());
    EXPECT_NEAR(sample_wavelength_nm(peak), 2.897771955e6 / 5000.0, sample_step_nm);
    EXPECT_EQ(spectrum[peak], 1.0);
}

TEST(Spectrum, ColorHasLuminanceOne) {
    for (const Spectrum& light :
         {blackbody_spectrum(2700.0), line_spectrum(630.0, 20.0), line_spectrum(455.0, 20.0)}) {
        const glm::dvec3 rgb = spectral_color(light);
        EXPECT_NEAR(0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z, 1.0, 2e-3);
    }
}

TEST(Spectrum, LineKeepsItsPowerAndPosition) {
    for (const double fwhm : {0.01, 1.0, 20.0}) {
        const Spectrum line = line_spectrum(589.3, fwhm);
        double power = 0.0, moment = 0.0;
        for (std::size_t k = 0; k < spectral_samples; ++k) {
            EXPECT_GE(line[k], -1e-18);
            power += line[k];
            moment += line[k] * sample_wavelength_nm(k);
        }
        EXPECT_NEAR(power, 1.0, 1e-12);
        EXPECT_NEAR(moment, 589.3, 1e-6);
    }
}

TEST(Spectrum, TabulatedLightIsIntegratedAgainstStraightPiecesExactly) {
    // Uneven wavelengths, against the ramp nm - 380: both integrals by hand.
    const std::vector<double> nm{300.0, 401.0, 402.5, 437.0, 900.0}, power{2.0, 2.0, 5.0, 0.0, 0.0};
    const Spectrum light = tabulated_spectrum(nm, power);
    double total = 0.0, ramp = 0.0;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        total += light[k] * sample_step_nm;
        ramp += light[k] * sample_step_nm * (sample_wavelength_nm(k) - 380.0);
    }
    EXPECT_NEAR(total, 21.0 * 2.0 + 1.5 * 3.5 + 34.5 * 2.5, 1e-10);
    const double trapezoid = 1.5 * (2.0 * 21.0 + 5.0 * 22.5 + 4.0 * 3.5 * 21.75) / 6.0;
    const double triangle = 0.5 * 5.0 * 34.5 * (22.5 + 34.5 / 3.0);
    EXPECT_NEAR(ramp, 2.0 * 21.0 * 10.5 + trapezoid + triangle, 1e-9);
}

TEST(Spectrum, TabulatedOnTheGridIsItselfAwayFromItsEnds) {
    std::vector<double> nm, power;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        nm.push_back(sample_wavelength_nm(k));
        power.push_back(10.0 + 3.0 * static_cast<double>(k));
    }
    const Spectrum light = tabulated_spectrum(nm, power);
    for (std::size_t k = 1; k + 1 < spectral_samples; ++k) EXPECT_NEAR(light[k], power[k], 1e-10);
}

TEST(Spectrum, RefusesWhatItCannotUse) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(blackbody_spectrum(499.0), std::invalid_argument);
    EXPECT_THROW(blackbody_spectrum(nan), std::invalid_argument);
    EXPECT_THROW(line_spectrum(300.0, 10.0), std::invalid_argument);
    EXPECT_THROW(line_spectrum(500.0, 0.0), std::invalid_argument);
    EXPECT_THROW(rgb_spectrum({0.0, nan, 0.0}), std::invalid_argument);
    const auto tabulated = [](std::vector<double> nm, std::vector<double> power) {
        tabulated_spectrum(nm, power);
    };
    EXPECT_THROW(tabulated({500.0}, {1.0}), std::invalid_argument);
    EXPECT_THROW(tabulated({500.0, 600.0}, {1.0}), std::invalid_argument);
    EXPECT_THROW(tabulated({500.0, 500.0}, {1.0, 1.0}), std::invalid_argument);
    EXPECT_THROW(tabulated({500.0, 600.0}, {1.0, -1.0}), std::invalid_argument);
    EXPECT_THROW(tabulated({500.0, nan}, {1.0, 1.0}), std::invalid_argument);
    EXPECT_THROW(tabulated({800.0, 900.0}, {1.0, 1.0}), std::invalid_argument);
    EXPECT_THROW(spectral_color(flat(0.0)), std::invalid_argument);
    EXPECT_THROW(spectral_color(flat(1.0), flat(nan)), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
