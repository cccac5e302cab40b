// Lights that shine as others do, whatever their color and power.
#include "shape/light_matching.h"

#include <gtest/gtest.h>

namespace skinglow::detail {
namespace {

Light point(double x, double power = 1.0, const glm::dvec3& color = glm::dvec3(1.0)) {
    return Light({.color = color, .position = {x, 0.0, 0.0}, .power = power});
}

Light sun(const glm::dvec3& direction, const glm::dvec3& position = glm::dvec3(0.0)) {
    return Light({.shape = SunLight{}, .position = position, .direction = direction});
}

using Indices = std::vector<std::size_t>;

TEST(MatchingLights, ColorAndPowerDoNotMatter) {
    const std::vector<Light> before = {point(1.0), point(2.0)};
    const std::vector<Light> after = {point(1.0, 5.0), point(2.0, 1.0, {1.0, 0.0, 0.5})};
    EXPECT_EQ(matching_lights(after, before), (Indices{0, 1}));
}

TEST(MatchingLights, AMovedOrChangedLightHasNone) {
    const Light wide({.shape = PointLight{.radius = 0.1}, .position = {1.0, 0.0, 0.0}});
    const Light spot({.shape = SpotLight{}, .position = {1.0, 0.0, 0.0}});
    const Light narrow({.shape = SpotLight{.spot_angle = 0.1}, .position = {1.0, 0.0, 0.0}});
    const std::vector<Light> before = {point(1.0), spot};
    const std::vector<Light> after = {point(1.5), wide, narrow, spot};
    EXPECT_EQ(matching_lights(after, before), (Indices{not_matched, not_matched, not_matched, 1}));
}

TEST(MatchingLights, WhatDoesNotMatterToAKindIsNotComparedSunsHaveNoPlaceAndPointsNoDirection) {
    const std::vector<Light> before = {sun({0.0, 0.0, 1.0}), sun({0.0, 1.0, 0.0}), point(3.0)};
    const std::vector<Light> after = {
        Light({.position = {3.0, 0.0, 0.0}, .direction = {1.0, 0.0, 0.0}}),
        sun({0.0, 0.0, 1.0}, {4.0, 5.0, 6.0}),
        sun({0.0, 2.0, 0.0}),
    };
    EXPECT_EQ(matching_lights(after, before), (Indices{2, 0, not_matched}));
}

TEST(MatchingLights, OneServesOnceAndOrderDoesNotMatter) {
    const std::vector<Light> before = {point(1.0), point(1.0), point(2.0)};
    const std::vector<Light> after = {point(2.0), point(1.0), point(1.0), point(1.0)};
    EXPECT_EQ(matching_lights(after, before), (Indices{2, 1, 0, not_matched}));
    EXPECT_TRUE(matching_lights({}, before).empty());
}

TEST(MatchingLights, ZeroIsZeroWhateverItsSign) {
    const std::vector<Light> before = {point(0.0), point(-0.0)};
    const std::vector<Light> after = {point(5.0), point(0.0), point(-0.0)};
    EXPECT_EQ(matching_lights(after, before), (Indices{not_matched, 1, 0}));
}

}  // namespace
}  // namespace skinglow::detail
