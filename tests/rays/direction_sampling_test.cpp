#include "rays/direction_sampling.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace skinglow {
namespace {

TEST(ConeDirections, StartAtTheAxisAndStayInTheCone) {
    const double half_angle = 0.6;
    const auto directions = cone_directions(500, half_angle);
    ASSERT_EQ(directions.size(), 500U);
    EXPECT_EQ(directions[0], glm::dvec3(0, 0, 1));
    glm::dvec3 sum(0);
    for (const glm::dvec3& d : directions) {
        EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
        EXPECT_GE(d.z, std::cos(half_angle));
        sum += d;
    }
    // As many to each side; and the mean height of a density that falls linearly over a cap of height h is 1
    // - h / 3.
    EXPECT_NEAR(sum.x / 500, 0, 2e-3);
    EXPECT_NEAR(sum.y / 500, 0, 2e-3);
    EXPECT_NEAR(sum.z / 500, 1 - (1 - std::cos(half_angle)) / 3, 1e-3);
}

TEST(CosineDirections, FollowLambert) {
    glm::dvec3 sum(0);
    const auto directions = cosine_directions(1000);
    for (const glm::dvec3& d : directions) {
        EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
        sum += d;
    }
    EXPECT_NEAR(sum.z / 1000, 2.0 / 3.0, 1e-3);  // integral of cos^2 / pi over the hemisphere
    EXPECT_NEAR(sum.x / 1000, 0, 2e-3);
}

TEST(InterquartileMean, CutsAQuarterOffEitherEnd) {
    std::array<WeightedValue, 4> even{{{100, 1}, {2, 1}, {4, 1}, {-50, 1}}};
    EXPECT_DOUBLE_EQ(interquartile_mean(even), 3.0);
    std::array<WeightedValue, 1> one{{{7, 0.3}}};
    EXPECT_DOUBLE_EQ(interquartile_mean(one), 7.0);
    // Weights 1, 2, 1 of 4: the middle one fills the middle half alone; 1, 1, 1 of 3 lets the ends in by a
    // quarter.
    std::array<WeightedValue, 3> heavy{{{0, 1}, {5, 2}, {100, 1}}};
    EXPECT_DOUBLE_EQ(interquartile_mean(heavy), 5.0);
    std::array<WeightedValue, 3> equal{{{0, 1}, {5, 1}, {100, 1}}};
    EXPECT_DOUBLE_EQ(interquartile_mean(equal), (0.25 * 0 + 5 + 0.25 * 100) / 1.5);
}

}  // namespace
}  // namespace skinglow
