#include <gtest/gtest.h>
#include <skinglow/rig.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flat_light.h"

using namespace skinglow;

namespace {

using std::numbers::pi;

FlatLight light_at(LightKind kind, const glm::dvec3& position, const glm::dvec3& direction = {0, 0, -1}) {
    FlatLight light;
    light.kind = kind;
    light.position = position;
    light.direction = direction;
    light.power = 10;
    return light;
}

}  // namespace

TEST(LightReport, TellsDistanceAnglesWeightAndShare) {
    std::vector<FlatLight> lights = {light_at(LightKind::point, {0, 0, 2}),
                                     light_at(LightKind::spot, {1, 0, 1}, {-1, 0, -1}),
                                     light_at(LightKind::point, {0, 0, -2})};
    lights[0].name = "Key";
    const std::vector<LightReportEntry> report =
        light_report(made(lights), glm::dvec3(0.0), glm::dvec3(0, 0, 1));
    EXPECT_EQ(report[0].name, "Key");
    EXPECT_EQ(report[0].distance, 2.0);
    EXPECT_NEAR(*report[0].normal_angle, 0.0, 1e-12);
    EXPECT_NEAR(report[0].weight.r, 10 / (16 * pi), 1e-12);
    EXPECT_NEAR(report[1].distance, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(*report[1].normal_angle, pi / 4, 1e-12);
    EXPECT_NEAR(report[1].axis_angle, 0.0, 1e-7);
    EXPECT_EQ(report[2].state, LightState::behind);
    EXPECT_NEAR(report[0].share + report[1].share, 1.0, 1e-12);
    EXPECT_NEAR(report[0].share / report[1].share, report[0].weight.r / report[1].weight.r, 1e-12);
}

TEST(LightReport, NamesEveryReason) {
    std::vector<FlatLight> lights(12, light_at(LightKind::point, {0, 0, 2}));
    lights[1].visible = false;
    lights[2].power = 0;
    lights[3].color = glm::dvec3(0.0);
    lights[4] = light_at(LightKind::spot, {0, 0, 2}, {1, 0, 0});
    lights[5] = light_at(LightKind::spot, {0, 0, 2});
    lights[5].spot_angle = 0;
    lights[6] = light_at(LightKind::area, {0, 0, 2}, {0, 0, 1});
    lights[7] = light_at(LightKind::area, {5, 0, 2});
    lights[7].spread = 0.5;
    lights[10].position = {0, 0, 1e200};
    lights[11] = light_at(LightKind::area, {0, 0, 2});
    lights[11].size_y = 0;
    std::vector<bool> occluded(lights.size());
    occluded[8] = true;
    const std::vector<std::size_t> kept = {0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 11};
    const std::vector<LightReportEntry> report =
        light_report(made(lights), glm::dvec3(0.0), std::nullopt, occluded, kept);
    const std::vector<std::string> expected = {"shines",       "hidden",   "zero power",   "black",
                                               "outside cone", "no width", "behind light", "outside cone",
                                               "occluded",     "culled",   "too weak",     "no width"};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(to_text(report[i].state), expected[i]) << i;
        EXPECT_EQ(report[i].share, i == 0 ? 1.0 : 0.0) << i;
        EXPECT_EQ(report[i].normal_angle, std::nullopt);
    }
}

TEST(LightReport, RefusesWhatDoesNotFit) {
    const std::vector<FlatLight> lights(2, light_at(LightKind::point, {0, 0, 2}));
    EXPECT_TRUE(light_report({}, glm::dvec3(0.0)).empty());
    EXPECT_THROW(light_report(made(lights), glm::dvec3(0.0), glm::dvec3(0.0)), std::invalid_argument);
    EXPECT_THROW(light_report(made(lights), glm::dvec3(0.0), std::nullopt, {true}), std::invalid_argument);
    EXPECT_THROW(light_report(made(lights), glm::dvec3(0.0), std::nullopt, {}, std::vector<std::size_t>{2}),
                 std::invalid_argument);
}
