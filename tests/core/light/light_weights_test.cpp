#include <gtest/gtest.h>
#include <skinglow/light_weights.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "table1.h"

namespace skinglow {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void expect_near_relative(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(value[i], expected[i], tolerance * std::abs(expected[i])) << "channel " << i;
}

TEST(Attenuation, MatchesTable1ByHand) {
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(attenuation(table1::distance[k]), table1::attenuation[k], 1e-15);
    }
}

TEST(Attenuation, HoldsAtExtremes) {
    EXPECT_EQ(attenuation(0.0), 1.0);
    EXPECT_EQ(attenuation(1e-30), 1.0);
    EXPECT_DOUBLE_EQ(attenuation(1e30), 1e-60);
    EXPECT_EQ(attenuation(1e300), 0.0) << "1e-600 is below the smallest double";
    EXPECT_EQ(attenuation(std::numeric_limits<double>::denorm_min()), 1.0);
    EXPECT_EQ(attenuation(123.0, {0, 0, 0}), 1.0) << "no attenuation asked for";
    EXPECT_EQ(attenuation(0.0, {0, 0, 1}), 1.0) << "1 / 0, then the minimum of Eq. 2";
    EXPECT_EQ(attenuation(1e300, {1, 0, 0}), 1.0) << "0 * (1e300)^2 must not become NaN";
    EXPECT_EQ(attenuation(0.0, {1, 1e308, 1e308}), 1.0);
    EXPECT_EQ(attenuation(1e308, {1e308, 1e308, 1e308}), 0.0);
    EXPECT_DOUBLE_EQ(attenuation(2.0, {0, 0.5, 0.25}), 0.5);
    EXPECT_EQ(attenuation(0.5, {0, 0, 1}), 1.0) << "never above 1";
}

TEST(Attenuation, FallsWithDistance) {
    double last = 1.0;
    for (double distance = 1e-3; distance < 1e6; distance *= 1.7) {
        const double now = attenuation(distance, {0.2, 0.1, 0.03});
        EXPECT_LE(now, last);
        EXPECT_GT(now, 0.0);
        last = now;
    }
}

TEST(Attenuation, RefusesWhatMakesNoSense) {
    for (const double bad : {-1.0, -1e-300, nan, inf}) {
        EXPECT_THROW(attenuation(bad), std::invalid_argument) << bad;
        EXPECT_THROW(attenuation(1.0, {bad, 0, 1}), std::invalid_argument) << bad;
        EXPECT_THROW(attenuation(1.0, {1, bad, 1}), std::invalid_argument) << bad;
        EXPECT_THROW(attenuation(1.0, {1, 0, bad}), std::invalid_argument) << bad;
    }
    try {
        attenuation(1.0, {1, -2, 1});
        FAIL() << "accepted a negative coefficient";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "attenuation coefficient k_l (linear) is -2; allowed: a finite number, 0 or more");
    }
}

TEST(LightWeights, MatchTable1ByHand) {
    const auto lights = table1::lights();
    const auto weights = light_weights(lights, glm::dvec3(0.0));
    ASSERT_EQ(weights.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) expect_near_relative(weights[k], table1::weight[k], 1e-14);
    expect_near_relative(light_weight(lights, glm::dvec3(0.0)), table1::total, 1e-14);
}

TEST(LightWeights, MeasureFromThePoint) {
    auto lights = table1::flat_lights();
    const glm::dvec3 away(3.0, -70.0, 0.25);
    for (FlatLight& light : lights) light.position += away;
    expect_near_relative(light_weight(made(lights), away), table1::total, 1e-13);
}

TEST(LightWeights, LeaveOutLightsThatAreOff) {
    auto lights = table1::flat_lights();
    lights[0].visible = false;
    lights[1].power = 0.0;
    lights[2].color = glm::dvec3(0.0);
    EXPECT_EQ(light_weight(made(lights), glm::dvec3(0.0)), glm::dvec3(0.0));
    for (const glm::dvec3& weight : light_weights(made(lights), glm::dvec3(0.0)))
        EXPECT_EQ(weight, glm::dvec3(0.0));
    lights[0].visible = true;
    expect_near_relative(light_weight(made(lights), glm::dvec3(0.0)), table1::weight[0], 1e-15);
}

TEST(LightWeights, GiveASunNoAttenuation) {
    FlatLight sun;
    sun.kind = LightKind::sun;
    sun.color = {0.25, 0.5, 4.0};
    sun.position = glm::dvec3(1e30);
    EXPECT_EQ(light_weight(made({sun}), glm::dvec3(0.0)), sun.color);
}

TEST(LightWeights, DoNotAskForPowerOrDirection) {
    auto lights = table1::flat_lights();
    for (FlatLight& light : lights) {
        light.power = 1e9;
        light.kind = LightKind::spot;
        light.direction = light.position;  // shines away from the point
    }
    expect_near_relative(light_weight(made(lights), glm::dvec3(0.0)), table1::total, 1e-14);
}

TEST(LightWeights, HoldAtExtremes) {
    EXPECT_EQ(light_weight({}, glm::dvec3(0.0)), glm::dvec3(0.0)) << "no lights: L = 0";
    FlatLight light;
    light.color = {0.0, 1e6, 1.0};
    EXPECT_EQ(light_weight(made({light}), glm::dvec3(0.0)), light.color) << "a light at the point itself";
    light.position = {1e-30, 0.0, 0.0};
    EXPECT_EQ(light_weight(made({light}), glm::dvec3(0.0)), light.color);
    light.position = {0.0, 1e30, 0.0};
    EXPECT_DOUBLE_EQ(light_weight(made({light}), glm::dvec3(0.0)).y, 1e-54);
    light.position = {1e300, 1e300, 1e300};
    EXPECT_EQ(light_weight(made({light}), glm::dvec3(0.0)), glm::dvec3(0.0)) << "not NaN";
}

TEST(LightWeights, SumTenThousandInAnyOrder) {
    std::mt19937_64 random(20261123);
    std::uniform_real_distribution<double> exponent(-6.0, 6.0);
    std::vector<FlatLight> lights(10000);
    for (FlatLight& light : lights) {
        light.color = glm::dvec3(std::pow(10.0, exponent(random)));  // over twelve decades
        light.position = {exponent(random), exponent(random), exponent(random)};
    }
    const glm::dvec3 first = light_weight(made(lights), glm::dvec3(0.0));
    long double exact = 0.0L;
    for (const glm::dvec3& weight : light_weights(made(lights), glm::dvec3(0.0)))
        exact += static_cast<long double>(weight.x);
    EXPECT_NEAR(first.x, static_cast<double>(exact), 4e-16 * first.x);
    for (int turn = 0; turn < 20; ++turn) {
        std::shuffle(lights.begin(), lights.end(), random);
        const glm::dvec3 again = light_weight(made(lights), glm::dvec3(0.0));
        EXPECT_NEAR(again.x, first.x, 4e-16 * first.x) << "two last bits";
    }
}

TEST(LightWeights, NameTheLightTheyRefuse) {
    auto lights = table1::flat_lights();
    lights[1].color.y = -0.5;
    try {
        light_weight(made(lights), glm::dvec3(0.0));
        FAIL() << "accepted a negative color";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("light \"Light2\" color"), std::string::npos)
            << error.what();
    }
    lights = table1::flat_lights();
    lights[2].position.z = nan;
    EXPECT_THROW(light_weights(made(lights), glm::dvec3(0.0)), std::invalid_argument);
    lights = table1::flat_lights();
    lights[0].color.x = inf;
    EXPECT_THROW(light_weights(made(lights), glm::dvec3(0.0)), std::invalid_argument);
    EXPECT_THROW(light_weights({}, glm::dvec3(0.0, nan, 0.0)), std::invalid_argument);
    FlatLight far;
    far.position = glm::dvec3(1.7e308);
    EXPECT_THROW(light_weight(made({far}), glm::dvec3(-1.7e308)), std::invalid_argument)
        << "the distance overflows";
    std::vector<FlatLight> bright(2);
    for (FlatLight& light : bright) light.color = glm::dvec3(1.7e308);
    EXPECT_THROW(light_weight(made(bright), glm::dvec3(0.0)), std::invalid_argument) << "the sum overflows";
}

TEST(LightKindNames, AreBlenders) {
    for (const LightKind kind : {LightKind::point, LightKind::sun, LightKind::spot, LightKind::area}) {
        EXPECT_EQ(light_kind(to_text(kind)), kind);
    }
    EXPECT_THROW(light_kind("point"), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
