#include <gtest/gtest.h>
#include <skinglow/lut.h>

#include <cmath>

namespace skinglow {
namespace {

TEST(SixGaussianLookup, IsWhiteAtNoThickness) {
    const auto lookup = six_gaussian_lookup({16, 12.0});
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(lookup.front()[i], 1.0, 1e-12) << "each column of the weights sums to 1";
}

TEST(SixGaussianLookup, MatchesHandValuesAtOneMillimeter) {
    // The published weights and variances summed in 30-digit decimals, apart from this code.
    const glm::dvec3 color = six_gaussian_lookup({13, 12.0})[1];
    EXPECT_NEAR(color.r, 0.3046776622082744, 1e-15);
    EXPECT_NEAR(color.g, 0.004562338037056251, 1e-15);
    EXPECT_NEAR(color.b, 0.0011999045641787574, 1e-15);
}

TEST(SixGaussianLookup, ReddensAndFallsWithThickness) {
    const auto lookup = six_gaussian_lookup({256, 12.0});
    for (std::size_t i = 1; i < lookup.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_LE(lookup[i][c], lookup[i - 1][c]);
        EXPECT_GE(lookup[i].r, lookup[i].g);
    }
    EXPECT_GT(lookup[20].r, 5.0 * lookup[20].b) << "about 0.94 mm";
}

TEST(SixGaussianLookup, HoldsAtExtremeThickness) {
    for (const double thickness : {1e-300, 1e300}) {
        for (const glm::dvec3& color : six_gaussian_lookup({3, thickness})) {
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(color[c] >= 0.0 && color[c] <= 1.0 + 1e-12) << color[c];
        }
    }
}

TEST(SixGaussianBase, IsTheBrightnessOfTheLookup) {
    const LutAxis axis(64, 12.0);
    const auto lookup = six_gaussian_lookup(axis);
    const BaseLut base = six_gaussian_base(axis);
    for (std::size_t i = 0; i < axis.size(); ++i) {
        const double gray = 0.2126 * lookup[i].r + 0.7152 * lookup[i].g + 0.0722 * lookup[i].b;
        EXPECT_NEAR(base.matrices()[i][0][0], gray, 1e-15);
        EXPECT_EQ(base.matrices()[i], glm::dmat3(base.matrices()[i][0][0])) << "gray";
    }
}

}  // namespace
}  // namespace skinglow
