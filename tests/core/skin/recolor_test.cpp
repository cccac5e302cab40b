#include <gtest/gtest.h>
#include <skinglow/light_weights.h>
#include <skinglow/lut.h>

#include <cmath>
#include <limits>

#include "table1.h"

namespace skinglow {
namespace {

TEST(Recolor, IsEquation1OnTable1) {
    const BaseLut base = BaseLut::from_gray(std::vector<double>{1.0, 0.25, 0.0}, 10.0);
    const glm::dvec3 weight = paper_blood_weight + light_weight(table1::lights(), glm::dvec3(0.0));
    const auto lut = recolor(base, weight);
    ASSERT_EQ(lut.size(), 3U);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(lut[0][i], table1::blood_and_light[i], 1e-14);
        EXPECT_NEAR(lut[1][i], table1::quarter_gray[i], 1e-14);
        EXPECT_EQ(lut[2][i], 0.0);
    }
}

TEST(Recolor, MultipliesRowByColumn) {
    // GLM is built by columns: this matrix has the rows (1 2 3) (4 5 6) (7 8 9).
    const BaseLut base({glm::dmat3(1, 4, 7, 2, 5, 8, 3, 6, 9)}, 1.0);
    EXPECT_EQ(recolor(base, {1.0, 10.0, 100.0})[0], glm::dvec3(321.0, 654.0, 987.0));
}

TEST(Recolor, IsLinearInTheWeight) {
    const BaseLut base({glm::dmat3(.5, .1, 0, .2, .4, -.1, 0, .1, .3), glm::dmat3(.1)}, 1.0);
    const glm::dvec3 a(0.3, 2.0, 5.0), b(7.0, 0.0, -1.0);
    const auto together = recolor(base, a + 3.0 * b), first = recolor(base, a), second = recolor(base, b);
    for (std::size_t i = 0; i < base.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(together[i][c], first[i][c] + 3.0 * second[i][c], 1e-14);
    }
}

TEST(Recolor, KeepsValuesAboveOne) {
    const BaseLut base = BaseLut::from_gray(std::vector<double>{4.0}, 1.0);
    EXPECT_EQ(recolor(base, glm::dvec3(1e6))[0], glm::dvec3(4e6));
}

TEST(Recolor, HoldsFor65536Texels) {
    std::vector<double> gray(max_lut_size);
    for (std::size_t i = 0; i < gray.size(); ++i) gray[i] = 1.0 / (1.0 + static_cast<double>(i));
    const auto lut = recolor(BaseLut::from_gray(gray, 12.0), {1.0, 2.0, 3.0});
    EXPECT_EQ(lut.back(), gray.back() * glm::dvec3(1.0, 2.0, 3.0));
}

TEST(Recolor, RefusesWhatWouldNotBeFinite) {
    const BaseLut base = BaseLut::from_gray(std::vector<double>{1.0, 10.0}, 1.0);
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(recolor(base, {1.0, inf, 1.0}), std::invalid_argument);
    EXPECT_THROW(recolor(base, {1.0, 1.0, std::nan("")}), std::invalid_argument);
    EXPECT_THROW(recolor(base, {1.7e308, 1.0, 1.0}), std::invalid_argument) << "10 * 1.7e308";
    std::vector<glm::dvec3> short_of_one(1);
    EXPECT_THROW(recolor(base, glm::dvec3(1.0), short_of_one), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
