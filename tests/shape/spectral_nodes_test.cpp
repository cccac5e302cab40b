// Color through a shape from few spectral nodes: on plane skin, where base_lut says what must come out.

#include "shape/spectral_nodes.h"

#include <gtest/gtest.h>
#include <skinglow/lut.h>
#include <skinglow/slab.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/each_vector_target.h"
#include "core/random_tissue.h"
#include "core/rounds.h"

namespace skinglow {
namespace {

/// Exitance of a plate of each node's medium, as a solver of shapes would find it.
std::vector<double> plates(const SpectralNodes& spectrum, double thickness_mm) {
    std::vector<double> exitance;
    for (const SpectralNodes::Node& node : spectrum.nodes) {
        const Layer layer{.refractive_index = spectrum.refractive_index,
                          .absorption = node.absorption,
                          .scattering = node.reduced_scattering,
                          .thickness = thickness_mm};
        exitance.push_back(node.entry_factor * slab({&layer, 1}, Incidence::diffuse()).transmittance *
                           node.exit_factor);
    }
    return exitance;
}

/// Largest error over 1 to 8 mm, per primary, of its largest number (the norm of SkinLutReport).
glm::dvec3 error_on_plates(const Tissue& tissue, int count) {
    const SpectralNodes spectrum = spectral_nodes(tissue, count);
    const BaseLut exact = base_lut(tissue, 9, 8.0);
    glm::dvec3 error(0.0);
    for (std::size_t i = 1; i < exact.size(); ++i) {
        const glm::dmat3 matrix = spectrum.combine(plates(spectrum, exact.axis().thickness_mm(i)));
        for (int j = 0; j < 3; ++j) {
            double difference = 0.0;
            double scale = 1e-6;
            for (int k = 0; k < 3; ++k) {
                difference = std::max(difference, std::abs(matrix[j][k] - exact.matrices()[i][j][k]));
                scale = std::max(scale, std::abs(exact.matrices()[i][j][k]));
            }
            error[j] = std::max(error[j], difference / scale);
        }
    }
    return error;
}

bool is_usable(const glm::dmat3& matrix) {
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
            if (!std::isfinite(matrix[j][k])) return false;
        }
    }
    return true;
}

TEST(SpectralNodes, PlatesOfAnyTissueAreCloseToTheTable) {
    std::mt19937 random(12);
    std::vector<double> errors;
    for (int i = 0; i < rounds(60); ++i) {
        const Tissue tissue = random_tissue(random);
        const glm::dvec3 error = error_on_plates(tissue, 4);
        errors.push_back(std::max({error.x, error.y, error.z}));
        // An epidermis that takes half of 1 mm of skin is more than a factor.
        EXPECT_LT(errors.back(), tissue.epidermal_thickness_mm > 0.12 ? 0.15 : 0.07);
    }
    std::sort(errors.begin(), errors.end());
    RecordProperty("median", std::to_string(errors[errors.size() / 2]));
    RecordProperty("largest", std::to_string(errors.back()));
    EXPECT_LT(errors[errors.size() / 2], 0.03);
}

TEST(SpectralNodes, PlatesOfEveryPresetAreCloseToTheTable) {
    for (const TissuePreset& preset : tissue_presets()) {
        const glm::dvec3 error = error_on_plates(preset.tissue, 4);
        RecordProperty(std::string(preset.name), std::to_string(std::max({error.x, error.y, error.z})));
        EXPECT_LT(std::max({error.x, error.y, error.z}), 0.06) << preset.name;
    }
}

TEST(SpectralNodes, NodesAscendAndAreMedia) {
    std::mt19937 random(7);
    for (int i = 0; i < 40; ++i) {
        const int count = 2 + i % 7;
        const SpectralNodes spectrum = spectral_nodes(random_tissue(random), count);
        ASSERT_EQ(spectrum.nodes.size(), static_cast<std::size_t>(count));
        double last = 0.0;
        for (const SpectralNodes::Node& node : spectrum.nodes) {
            EXPECT_GT(node.absorption, 0.0);
            EXPECT_GT(node.reduced_scattering, 0.0);
            EXPECT_GT(node.entry_factor, 0.0);
            EXPECT_LT(node.entry_factor, 4.0);
            EXPECT_EQ(node.exit_factor, node.entry_factor);
            const double attenuation =
                std::sqrt(3.0 * node.absorption * (node.absorption + node.reduced_scattering));
            EXPECT_GT(attenuation, 1.01 * last);
            last = attenuation;
        }
    }
}

TEST(SpectralNodes, EveryCornerOfTheRangesGivesFiniteMatrices) {
    const auto parameters = tissue_parameters();
    for (unsigned corner = 0; corner < (1U << parameters.size()); ++corner) {
        Tissue tissue;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            tissue.*parameters[i].field =
                (corner >> i & 1U) != 0 ? parameters[i].maximum : parameters[i].minimum;
        }
        const SpectralNodes spectrum = spectral_nodes(tissue);
        for (const double thickness_mm : {0.01, 0.3, 4.0, 40.0}) {
            const glm::dmat3 matrix = spectrum.combine(plates(spectrum, thickness_mm));
            EXPECT_TRUE(is_usable(matrix)) << "corner " << corner << ", " << thickness_mm << " mm";
            EXPECT_LT(std::abs(matrix[0][0]), 2.0) << "corner " << corner << ", " << thickness_mm << " mm";
        }
    }
}

TEST(SpectralNodes, ExitanceIsLinearInTheLight) {
    const SpectralNodes spectrum = spectral_nodes({});
    const std::vector<double> once = plates(spectrum, 3.0);
    std::vector<double> thrice = once;
    for (double& value : thrice) value *= 3.0;
    const glm::dmat3 a = spectrum.combine(once);
    const glm::dmat3 b = spectrum.combine(thrice);
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(b[j][k], 3.0 * a[j][k], 1e-6);
    }
}

TEST(SpectralNodes, NoLightAtAllNodesIsNoLight) {
    const SpectralNodes spectrum = spectral_nodes({});
    for (const double value : {0.0, -1e-9, -1.0}) {
        EXPECT_EQ(spectrum.combine(std::vector<double>(4, value)), glm::dmat3(0.0));
    }
}

TEST(SpectralNodes, NoiseOfDimNodesChangesLittle) {
    const SpectralNodes spectrum = spectral_nodes({});
    const std::vector<double> clean = plates(spectrum, 4.0);
    const glm::dmat3 exact = spectrum.combine(clean);
    for (const double value : {0.0, -1e-6, -0.5}) {
        std::vector<double> noisy = clean;
        noisy[3] = value;
        EXPECT_NEAR(spectrum.combine(noisy)[0][0], exact[0][0], 0.01 * exact[0][0]);
        noisy[2] = value;
        EXPECT_NEAR(spectrum.combine(noisy)[0][0], exact[0][0], 0.3 * exact[0][0]);
    }
    std::vector<double> hole = clean;
    hole[1] = 0.0;
    EXPECT_NEAR(spectrum.combine(hole)[0][0], exact[0][0], 0.3 * exact[0][0]);
}

/// A node is not known or unknown: a trace of light at it is as none.
TEST(SpectralNodes, TracesOfLightAtANodeAreAsNone) {
    const SpectralNodes spectrum = spectral_nodes({});
    const std::vector<double> clean = plates(spectrum, 4.0);
    for (unsigned dark = 1; dark < 15; ++dark) {
        const auto with = [&](double value) {
            std::vector<double> exitance = clean;
            for (std::size_t k = 0; k < 4; ++k) {
                if ((dark >> k & 1U) != 0) exitance[k] = value;
            }
            return spectrum.combine(exitance);
        };
        const glm::dmat3 none = with(0.0);
        EXPECT_GT(none[0][0], 0.0) << dark;
        for (const double trace : {-1e-9, 1e-300, 1e-40}) {
            const glm::dmat3 some = with(trace);
            for (int j = 0; j < 3; ++j) {
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(some[j][k], none[j][k], 1e-9) << dark << ' ' << trace;
            }
        }
    }
}

TEST(SpectralNodes, AnyExitanceGivesFiniteMatrices) {
    const SpectralNodes spectrum = spectral_nodes(tissue_preset("very_dark").tissue);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> exponent(-300.0, 2.0);
    std::uniform_int_distribution<int> kind(0, 3);
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> values;
        for (int k = 0; k < 4; ++k) {
            const double size = std::pow(10.0, exponent(random));
            values.push_back(kind(random) == 0 ? 0.0 : kind(random) == 0 ? -size : size);
        }
        EXPECT_TRUE(is_usable(spectrum.combine(values)));
    }
}

TEST(SpectralNodes, EveryInstructionSetFindsTheSame) {
    const SpectralNodes spectrum = spectral_nodes({}, 5);
    const std::vector<double> exitance = plates(spectrum, 2.0);
    const glm::dmat3 expected = spectrum.combine(exitance);
    for_each_vector_target([&] {
        const glm::dmat3 matrix = spectrum.combine(exitance);
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(matrix[j][k], expected[j][k], 1e-6);
        }
    });
}

TEST(SpectralNodes, WrongArgumentsAreRefusedInWords) {
    EXPECT_THROW(spectral_nodes({}, 1), std::invalid_argument);
    EXPECT_THROW(spectral_nodes({}, 9), std::invalid_argument);
    EXPECT_THROW(spectral_nodes({.melanin_fraction = 2.0}), std::invalid_argument);
    const std::vector<double> three(3, 1.0);
    EXPECT_THROW(static_cast<void>(spectral_nodes({}).combine(three)), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
