#include <gtest/gtest.h>
#include <skinglow/lut.h>
#include <skinglow/spectrum.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "random_tissue.h"
#include "rounds.h"

namespace skinglow {
namespace {

constexpr int exact_streams = 24;  // 1e-6 off: docs/accuracy.md

TEST(SkinLut, ReferenceIsTheSpectralSumAtEveryEntry) {
    const Tissue tissue = tissue_preset("medium").tissue;
    const BaseLut lut = reference_lut(tissue, 5, 4.0, 8);
    std::vector<double> nm;
    for (std::size_t k = 0; k < spectral_samples; ++k) nm.push_back(sample_wavelength_nm(k));
    const auto t = transmittance(tissue, lut.axis().thickness_mm(), nm, Incidence::diffuse(), 8);
    for (std::size_t i = 0; i < lut.size(); ++i) {
        Spectrum filter{};
        std::copy_n(t.begin() + static_cast<std::ptrdiff_t>(i * spectral_samples), spectral_samples,
                    filter.begin());
        const glm::dmat3 expected = transmission_matrix(filter);
        for (int j = 0; j < 3; ++j) {
            for (int row = 0; row < 3; ++row) EXPECT_NEAR(lut.matrices()[i][j][row], expected[j][row], 1e-14);
        }
    }
}

TEST(SkinLut, EstimateBoundsTheErrorOnRandomSkins) {
    std::mt19937 random(2024);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < rounds(30); ++trial) {
        const Tissue tissue = random_tissue(random);
        const double max_thickness_mm = 1.0 + 19.0 * uniform(random);
        const double tolerance = std::pow(10.0, -1.0 - 3.0 * uniform(random));
        const std::size_t size = trial % 4 == 0 ? 9 : 40;
        const SkinLut found = base_lut_report(tissue, size, max_thickness_mm, tolerance);
        const double error =
            lut_error(found.lut, reference_lut(tissue, size, max_thickness_mm, exact_streams));
        EXPECT_LE(error, found.report.estimated_error) << "trial " << trial << ", tolerance " << tolerance;
        EXPECT_LE(found.report.estimated_error, tolerance) << "trial " << trial;
    }
}

TEST(SkinLut, EveryPresetMeetsEveryTolerance) {
    for (const TissuePreset& preset : tissue_presets()) {
        const BaseLut exact = reference_lut(preset.tissue, 100, 12.0, exact_streams);
        for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
            EXPECT_LE(lut_error(base_lut(preset.tissue, 100, 12.0, tolerance), exact), tolerance)
                << preset.name;
        }
    }
}

TEST(SkinLut, SolvesLessForLess) {
    int before = 0;
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        const SkinLutReport report = base_lut_report({}, 4, 12.0, tolerance).report;
        EXPECT_GT(report.streams, before);
        EXPECT_LE(report.estimated_error, tolerance);
        before = report.streams;
    }
}

TEST(SkinLut, IsTheSameOnAnyNumberOfThreads) {
    const BaseLut one = reference_lut({}, 64, 12.0, 8, 1);
    for (const int threads : {0, 2, 7}) {
        const BaseLut lut = reference_lut({}, 64, 12.0, 8, threads);
        EXPECT_TRUE(std::ranges::equal(lut.matrices(), one.matrices())) << threads;
    }
}

TEST(SkinLut, ColorFadesToRedAndEveryPrimaryFades) {
    const BaseLut lut = base_lut(tissue_preset("light").tissue);
    double before = 2.0;
    for (std::size_t i = 0; i < lut.size(); ++i) {
        const glm::dvec3 white = lut.matrices()[i] * glm::dvec3(1.0);
        const double luminance = 0.2126 * white.x + 0.7152 * white.y + 0.0722 * white.z;
        EXPECT_LT(luminance, before);
        before = luminance;
        if (lut.axis().thickness_mm(i) > 1.0) {
            EXPECT_GT(white.x, white.y);
            EXPECT_GT(white.x, 2.0 * white.z);
        }
    }
}

TEST(SkinLut, AnyTableSizeAndThicknessWorks) {
    for (const std::size_t size : {1U, 2U, 7U, 300U}) {
        for (const double max_thickness_mm : {1e-3, 0.13, 100.0}) {
            const SkinLut found = base_lut_report({}, size, max_thickness_mm, 1e-3);
            EXPECT_EQ(found.lut.size(), size);
            const BaseLut exact = reference_lut({}, size, max_thickness_mm, exact_streams);
            EXPECT_LE(lut_error(found.lut, exact), found.report.estimated_error)
                << size << ' ' << max_thickness_mm;
        }
    }
}

TEST(SkinLut, RefusesBadInput) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(base_lut({}, 0), std::invalid_argument);
    EXPECT_THROW(base_lut({}, 256, 0.0), std::invalid_argument);
    EXPECT_THROW(base_lut({}, 256, nan), std::invalid_argument);
    for (const double tolerance : {0.0, 1e-7, 0.2, -1.0, nan}) {
        EXPECT_THROW(base_lut({}, 256, 12.0, tolerance), std::invalid_argument);
    }
    Tissue bad;
    bad.melanin_fraction = 0.9;
    EXPECT_THROW(base_lut(bad), std::invalid_argument);
    EXPECT_THROW(reference_lut({}, 256, 12.0, 15), std::invalid_argument);
    EXPECT_THROW(lut_error(base_lut({}, 4), base_lut({}, 5)), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
