#include <gtest/gtest.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace skinglow {
namespace {

std::string refusal(const Tissue& tissue) {
    try {
        validate(tissue);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Tissue, BloodHasItsCheckValues) {
    // 150 g/L, oxygenated: 336 /cm at 450 nm, 112 /cm at 500 nm, ln 10 included.
    EXPECT_NEAR(blood_absorption(450.0, 1.0), 33.6, 0.05);
    EXPECT_NEAR(blood_absorption(500.0, 1.0), 11.2, 0.05);
    // By hand from the CSV's row at 600 nm: ln(10) * extinction * 150 / 64500, in 1/mm.
    EXPECT_NEAR(blood_absorption(600.0, 1.0), 0.1 * std::log(10.0) * 3200.0 * 150.0 / 64500.0, 1e-12);
    EXPECT_NEAR(blood_absorption(600.0, 0.0), 0.1 * std::log(10.0) * 14677.2 * 150.0 / 64500.0, 1e-12);
    EXPECT_NEAR(blood_absorption(450.0, 0.25),
                0.25 * blood_absorption(450.0, 1.0) + 0.75 * blood_absorption(450.0, 0.0), 1e-12);
}

TEST(Tissue, BloodIsStraightBetweenRowsAndDefinedAtBothEnds) {
    EXPECT_NEAR(blood_absorption(451.0, 1.0),
                0.5 * (blood_absorption(450.0, 1.0) + blood_absorption(452.0, 1.0)), 1e-12);
    EXPECT_GT(blood_absorption(380.0, 0.5), 0.0);
    EXPECT_GT(blood_absorption(780.0, 0.5), 0.0);
    EXPECT_NEAR(blood_absorption(779.999999, 0.5), blood_absorption(780.0, 0.5), 1e-6);
}

TEST(Tissue, FormulasHaveTheirPublishedValues) {
    EXPECT_NEAR(melanosome_absorption(500.0), 0.1 * 1.70e12 * std::exp(-3.48 * std::log(500.0)), 1e-9);
    EXPECT_NEAR(bloodless_absorption(500.0), 0.1 * (0.244 + 85.3 * std::exp(-346.0 / 66.2)), 1e-12);
    // At 500 nm the reduced scattering is the tabulated a', by definition of the formula.
    const SkinMedia media = skin_media({}, 500.0);
    EXPECT_NEAR(media.epidermis.scattering * (1.0 - media.epidermis.anisotropy), 6.67, 1e-12);
    EXPECT_NEAR(media.inner.scattering * (1.0 - media.inner.anisotropy), 4.36, 1e-12);
    EXPECT_NEAR(media.epidermis.anisotropy, 0.745, 1e-12);
    EXPECT_NEAR(skin_media({}, 700.0).epidermis.anisotropy, 0.804, 1e-12);
    EXPECT_NEAR(skin_media({}, 650.0).epidermis.anisotropy, 0.789, 1e-12);
}

TEST(Tissue, MixesByVolume) {
    Tissue tissue;
    tissue.melanin_fraction = 0.2;
    tissue.blood_fraction = 0.04;
    const SkinMedia media = skin_media(tissue, 560.0);
    EXPECT_NEAR(media.epidermis.absorption,
                0.2 * melanosome_absorption(560.0) + 0.8 * bloodless_absorption(560.0), 1e-12);
    EXPECT_NEAR(media.inner.absorption,
                0.04 * blood_absorption(560.0, tissue.oxygen_saturation) + 0.96 * bloodless_absorption(560.0),
                1e-12);
    tissue.cartilage_fraction = 1.0;
    const Layer cartilage = skin_media(tissue, 560.0).inner;
    tissue.blood_fraction = 0.0;
    EXPECT_EQ(skin_media(tissue, 560.0).inner.absorption, cartilage.absorption);  // cartilage holds no blood
    tissue.cartilage_fraction = 0.5;
    tissue.blood_fraction = 0.04;
    EXPECT_NEAR(skin_media(tissue, 560.0).inner.absorption,
                0.5 * (cartilage.absorption + media.inner.absorption), 1e-12);
    tissue.scattering_scale = 2.0;
    EXPECT_NEAR(skin_media(tissue, 560.0).inner.scattering, cartilage.scattering + media.inner.scattering,
                1e-12);
}

TEST(Tissue, CartilageHasTheValuesItWasTakenFrom) {
    Tissue tissue;
    tissue.cartilage_fraction = 1.0;
    // Kubelka-Munk K falls from 7 /cm at 330 nm to 1 /cm at 850 nm as a power of wavelength; K = 2 mua.
    const double exponent = std::log(7.0) / std::log(850.0 / 330.0);
    EXPECT_NEAR(skin_media(tissue, 700.0).inner.absorption, 0.05 * std::pow(850.0 / 700.0, exponent), 1e-12);
    const Layer layer = skin_media(tissue, 700.0).inner;
    const double kubelka_munk_s =
        (3.0 * layer.scattering * (1.0 - layer.anisotropy) - layer.absorption) / 4.0;
    EXPECT_NEAR(kubelka_munk_s, 0.6 * std::pow(850.0 / 700.0, std::log(40.0 / 6.0) / std::log(850.0 / 360.0)),
                1e-12);
}

TEST(Tissue, OuterLayersKeepTheirThicknessAndTheInnerTakesTheRest) {
    Tissue tissue;
    tissue.epidermal_thickness_mm = 0.1;
    for (const double total : {0.0, 0.05, 0.19999, 0.2, 0.20001, 1.0, 12.0}) {
        const auto skin = skin_layers(tissue, total, 500.0);
        ASSERT_EQ(skin.size(), 3U);
        EXPECT_EQ(skin[0].thickness, skin[2].thickness);
        EXPECT_EQ(skin[0].thickness, std::min(0.1, 0.5 * total));
        EXPECT_GE(skin[1].thickness, 0.0);
        EXPECT_NEAR(skin[0].thickness + skin[1].thickness + skin[2].thickness, total, 1e-15);
    }
}

TEST(Tissue, PresetsAreValidNamedOnceAndDescribed) {
    std::set<std::string_view> names;
    for (const TissuePreset& preset : tissue_presets()) {
        EXPECT_NO_THROW(validate(preset.tissue)) << preset.name;
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_GT(preset.description.size(), 20U);
        EXPECT_EQ(&tissue_preset(preset.name), &preset);
    }
    EXPECT_EQ(tissue_preset("light").tissue.melanin_fraction, Tissue{}.melanin_fraction);
    EXPECT_THROW(tissue_preset("green"), std::invalid_argument);
}

TEST(Tissue, RefusesEveryParameterOutOfItsRangeAndSaysTheRange) {
    for (const TissueParameter& parameter : tissue_parameters()) {
        for (const double end : {parameter.minimum, parameter.maximum}) {
            Tissue tissue;
            tissue.*parameter.field = end;
            EXPECT_EQ(refusal(tissue), "") << parameter.name;
            for (const double bad :
                 {end + (end == parameter.minimum ? -1e-6 : 1e-6), std::numeric_limits<double>::quiet_NaN(),
                  std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
                tissue.*parameter.field = bad;
                const std::string message = refusal(tissue);
                EXPECT_NE(message.find(parameter.name), std::string::npos) << message;
                EXPECT_NE(message.find(" to "), std::string::npos) << message;
            }
        }
    }
}

TEST(Tissue, RefusesWavelengthsWithoutData) {
    for (const double nm : {379.9, 780.1, 0.0, -500.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(blood_absorption(nm, 0.5), std::invalid_argument);
        EXPECT_THROW(melanosome_absorption(nm), std::invalid_argument);
        EXPECT_THROW(skin_media({}, nm), std::invalid_argument);
    }
    EXPECT_THROW(blood_absorption(500.0, 1.1), std::invalid_argument);
    EXPECT_THROW(skin_layers({}, -1.0, 500.0), std::invalid_argument);
    EXPECT_THROW(skin_layers({}, std::numeric_limits<double>::infinity(), 500.0), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
