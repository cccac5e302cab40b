#include <gtest/gtest.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "random_tissue.h"

namespace skinglow {
namespace {

std::vector<double> at(const Tissue& tissue, const std::vector<double>& thickness_mm, double wavelength_nm,
                       Incidence incidence = Incidence::diffuse(), int streams = 16) {
    return transmittance(tissue, thickness_mm, std::vector<double>{wavelength_nm}, incidence, streams);
}

TEST(SkinTransmittance, IsTheSlabOfItsLayers) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int trial = 0; trial < 40; ++trial) {
        const Tissue tissue = random_tissue(random);
        const double nm = 380.0 + 400.0 * uniform(random),
                     thickness = 4.0 * uniform(random) * uniform(random);
        for (const Incidence incidence :
             {Incidence::diffuse(), Incidence::normal(), Incidence::oblique(0.4)}) {
            const double solved =
                slab(skin_layers(tissue, thickness, nm), incidence, 1.0, 1.0, 16).transmittance;
            EXPECT_NEAR(at(tissue, {thickness}, nm, incidence)[0] / solved, 1.0, 1e-9)
                << thickness << " mm, " << nm << " nm";
        }
    }
}

TEST(SkinTransmittance, IsLaidOutByThicknessThenWavelength) {
    const std::vector<double> thickness{3.0, 0.05, 1.0}, nm{450.0, 650.0};
    const auto all = transmittance({}, thickness, nm);
    ASSERT_EQ(all.size(), 6U);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 2; ++j)
            EXPECT_DOUBLE_EQ(all[2 * i + j], at({}, {thickness[i]}, nm[j])[0]);
    }
}

TEST(SkinTransmittance, FallsWithThicknessThroughTheKink) {
    std::mt19937 random(11);
    for (int trial = 0; trial < 30; ++trial) {
        const Tissue tissue = random_tissue(random);
        std::vector<double> thickness;
        for (int i = 0; i <= 300; ++i) thickness.push_back(1e-4 * i * i);
        for (const double nm : {420.0, 560.0, 700.0}) {
            const auto t = at(tissue, thickness, nm);
            for (std::size_t i = 1; i < t.size(); ++i) {
                EXPECT_GT(t[i], 0.0);
                EXPECT_LT(t[i], t[i - 1]) << "at " << thickness[i] << " mm";
            }
        }
    }
}

TEST(SkinTransmittance, IsContinuousWhereTheDermisBegins) {
    Tissue tissue;
    tissue.epidermal_thickness_mm = 0.1;
    const double just = 1e-9;
    const auto t = at(tissue, {0.2 - just, 0.2, 0.2 + just}, 500.0);
    EXPECT_NEAR(t[0] / t[1], 1.0, 1e-6);
    EXPECT_NEAR(t[2] / t[1], 1.0, 1e-6);
}

TEST(SkinTransmittance, DependsOnBloodMelaninAndOxygenAsSkinDoes) {
    Tissue more_blood, more_melanin, less_oxygen;
    more_blood.blood_fraction = 0.04;
    more_melanin.melanin_fraction = 0.3;
    less_oxygen.oxygen_saturation = 0.5;
    for (const double nm : {450.0, 550.0, 650.0}) {
        const double usual = at({}, {3.0}, nm)[0];
        EXPECT_LT(at(more_blood, {3.0}, nm)[0], usual);
        EXPECT_LT(at(more_melanin, {3.0}, nm)[0], usual);
    }
    EXPECT_LT(at(less_oxygen, {3.0}, 660.0)[0], at({}, {3.0}, 660.0)[0]);  // dark blood is blue
    EXPECT_GT(at({}, {3.0}, 650.0)[0], 20.0 * at({}, {3.0}, 550.0)[0]);    // an ear glows red
}

TEST(SkinTransmittance, RefusesBadInput) {
    EXPECT_THROW(at({}, {-1.0}, 500.0), std::invalid_argument);
    EXPECT_THROW(at({}, {std::numeric_limits<double>::quiet_NaN()}, 500.0), std::invalid_argument);
    EXPECT_THROW(at({}, {1.0}, 800.0), std::invalid_argument);
    EXPECT_THROW(at({}, {1.0}, 500.0, Incidence::oblique(0.0)), std::invalid_argument);
    EXPECT_THROW(at({}, {1.0}, 500.0, Incidence::diffuse(), 7), std::invalid_argument);
    EXPECT_TRUE(at({}, {}, 500.0).empty());
}

}  // namespace
}  // namespace skinglow
