#include "rays/direction_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int count = 20000;
constexpr int bins = 10;  // along each of the two coordinates
/// Of 99 degrees of freedom: exceeded by one sound random sampler in a million, and never by an even one.
constexpr double chi_square_limit = 176.0;

/// Chi-square of counts in bins of equal probability: by what `fraction` makes of the height, and by azimuth.
template <typename Fraction>
double chi_square(const std::vector<glm::dvec3>& directions, const Fraction& fraction) {
    std::array<double, bins * bins> counts{};
    for (const glm::dvec3& d : directions) {
        const double turn = 0.5 + std::atan2(d.y, d.x) / (2 * pi);
        const auto bin = [](double x) { return std::clamp(static_cast<int>(x * bins), 0, bins - 1); };
        ++counts[static_cast<std::size_t>(bin(fraction(d.z)) * bins + bin(turn))];
    }
    const double expected = static_cast<double>(directions.size()) / (bins * bins);
    double sum = 0;
    for (const double found : counts) sum += (found - expected) * (found - expected) / expected;
    return sum;
}

TEST(ConeDirections, FallLinearlyInTheCosine) {
    for (const double half_angle : {0.01, 0.6, 1.5}) {
        const double height = 1 - std::cos(half_angle);
        const auto linear = [&](double z) { return 1 - std::pow(1 - (1 - z) / height, 2); };
        const auto even = [&](double z) { return (1 - z) / height; };
        EXPECT_LT(chi_square(cone_directions(count, half_angle), linear), chi_square_limit) << half_angle;
        EXPECT_GT(chi_square(cone_directions(count, half_angle), even), chi_square_limit) << half_angle;
    }
}

TEST(CosineDirections, HaveTheCosinesDistribution) {
    const auto lambert = [](double z) { return 1 - z * z; };
    const auto even = [](double z) { return 1 - z; };
    EXPECT_LT(chi_square(cosine_directions(count), lambert), chi_square_limit);
    EXPECT_GT(chi_square(cosine_directions(count), even), chi_square_limit);
}

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
