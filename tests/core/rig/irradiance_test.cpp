#include <gtest/gtest.h>
#include <skinglow/light.h>
#include <skinglow/light_weights.h>
#include <skinglow/rig.h>
#include <skinglow/surface_lighting.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "random_lights.h"

using namespace skinglow;

namespace {

using std::numbers::pi;

FlatLight light_at(LightKind kind, double power) {
    FlatLight light;
    light.kind = kind;
    light.power = power;
    light.position = {0, 0, 2};
    return light;
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string message_of(const FlatLight& light) {
    try {
        irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1});
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST(Irradiance, PointSpotAndSunAreTheirFormulae) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0, 1, 1));
    const double point = 100 / (4 * pi * 4);
    EXPECT_NEAR(irradiance_at({light_at(LightKind::point, 100)}, glm::dvec3(0.0), {0, 0, 3}).r, point, 1e-13);
    EXPECT_NEAR(irradiance_at({light_at(LightKind::point, 100)}, glm::dvec3(0.0), normal).r,
                point * std::sqrt(0.5), 1e-13);
    EXPECT_EQ(irradiance_at({light_at(LightKind::point, 100)}, glm::dvec3(0.0), {0, 0, -1}).r, 0.0);
    EXPECT_NEAR(irradiance_at({light_at(LightKind::sun, 5)}, glm::dvec3(0.0), normal).r, 5 * std::sqrt(0.5),
                1e-13);

    FlatLight spot = light_at(LightKind::spot, 100);
    spot.spot_angle = 1.0;
    spot.spot_blend = 0.5;
    EXPECT_NEAR(irradiance_at({spot}, glm::dvec3(0.0), {0, 0, 1}).r, point, 1e-13);
    const double aside = 2 * std::tan(0.45);
    const double cosine = std::cos(0.45);
    const double t = (cosine - std::cos(0.5)) / (0.5 * (1 - std::cos(0.5)));
    EXPECT_NEAR(irradiance_at({spot}, {aside, 0, 0}, {0, 0, 1}).r,
                point * std::pow(cosine, 3) * t * t * (3 - 2 * t), 1e-13);
    EXPECT_EQ(irradiance_at({spot}, {2 * std::tan(0.51), 0, 0}, {0, 0, 1}).r, 0.0);
    spot.spot_cosine = true;
    EXPECT_NEAR(irradiance_at({spot}, {aside, 0, 0}, {0, 0, 1}).r,
                point * std::pow(cosine, 4) * t * t * (3 - 2 * t), 1e-13);
}

TEST(Irradiance, SoftLightsAreWhatCyclesRenders) {
    FlatLight light = light_at(LightKind::point, 100);
    light.radius = 0.5;
    // docs: measured with Cycles 3.4 to 5.2 on a white Lambert plane.
    EXPECT_NEAR(irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1}).r, 1.8724, 5e-5);
    light.soft_falloff = false;
    EXPECT_NEAR(irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1}).r, 100 / (4 * pi * 4), 1e-13);
    // Within a ball light comes from everywhere with the ball's radiance.
    EXPECT_NEAR(irradiance_at({light}, {0.1, 0, 2.2}, {1, 0, 0}).r, 100 / (4 * pi * 0.25), 1e-10);
}

TEST(Irradiance, FarAreaLightsOfEveryShapeAreAlike) {
    for (const AreaShape shape : {AreaShape::rectangle, AreaShape::ellipse}) {
        FlatLight light = light_at(LightKind::area, 100);
        light.area_shape = shape;
        for (const double size : {1e-300, 1e-30, 1e-9, 1e-5, 1e-3, 0.01}) {
            light.size_x = size;
            light.size_y = 0.5 * size;
            EXPECT_NEAR(irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1}).r, 100 / (pi * 4), 1e-4) << size;
            EXPECT_NEAR(irradiance_at({light}, {2, 0, 0}, {0, 0, 1}).r, 100 / (pi * 8) * 0.5, 1e-4) << size;
        }
        EXPECT_EQ(irradiance_at({light}, {0, 0, 2.5}, {0, 0, -1}).r, 0.0);
    }
    FlatLight line = light_at(LightKind::area, 100);
    line.size_x = 1.0;
    line.size_y = 1e-9;
    // A Lambert line along x: integral of h^2 / (x^2 + h^2)^2 dx / (pi length).
    const double expected = 100 / pi * (0.5 / (4 + 0.25) + std::atan(0.25) / 2);
    EXPECT_NEAR(irradiance_at({line}, glm::dvec3(0.0), {0, 0, 1}).r, expected, 1e-6 * expected);
}

TEST(Irradiance, AreaLightWithASizeOfZeroGivesNone) {
    // Measured: Cycles 3.4, 4.5, 5.0 and 5.2 render nothing of one (tests/blender/inside/light_units.py).
    for (const AreaShape shape : {AreaShape::rectangle, AreaShape::ellipse}) {
        for (const auto& [size_x, size_y] : {std::pair(0.0, 1.0), std::pair(1.0, 0.0), std::pair(0.0, 0.0)}) {
            FlatLight light = light_at(LightKind::area, 100);
            light.area_shape = shape;
            light.size_x = size_x;
            light.size_y = size_y;
            const PreparedRig rig({light});
            const Box box{glm::dvec3(-1.0), glm::dvec3(1.0)};
            EXPECT_EQ(irradiance_at(rig, glm::dvec3(0.0), {0, 0, 1}), glm::dvec3(0.0));
            EXPECT_EQ(object_irradiance(rig, glm::dvec3(0.0)), glm::dvec3(0.0));
            const glm::dvec3 origin(0.0);
            const glm::dvec3 up(0, 0, 1);
            EXPECT_EQ(surface_irradiance(rig, {&origin, 1}, {&up, 1})[0], glm::dvec3(0.0));
            EXPECT_EQ(rig.cull(box, 0.0).dropped[0].reason, DropReason::off);
            EXPECT_TRUE(SurfaceLighting(rig, box).terms().empty());
            EXPECT_EQ(light_weight(rig.lights(), glm::dvec3(0.0)),
                      glm::dvec3(0.2));  // mode `paper`: 1 / (1 + 2^2)
            light.size_x = std::max(size_x, std::numeric_limits<double>::denorm_min());
            light.size_y = std::max(size_y, std::numeric_limits<double>::denorm_min());
            EXPECT_GT(irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1}).r, 5.0);
        }
    }
}

TEST(Irradiance, ObjectWeightIsTheSumOfFacingSurfacesInAnyOrder) {
    RandomScene random(5);
    std::vector<Light> lights = random.lights(40);
    const glm::dvec3 point(0.3, -0.1, 0.2);
    const std::vector<glm::dvec3> parts = object_irradiance_by_light(lights, point);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const glm::dvec3 towards =
            lights[i].kind() == LightKind::sun ? -lights[i].direction() : lights[i].position() - point;
        const glm::dvec3 expected = irradiance_at({lights[i]}, point, towards);
        EXPECT_NEAR(parts[i].g, expected.g, 1e-12 * std::abs(expected.g)) << i;
        sum += parts[i];
    }
    const glm::dvec3 total = object_irradiance(lights, point);
    EXPECT_NEAR(total.r, sum.r, 1e-9 * std::abs(sum.r));
    for (int i = 0; i < 20; ++i) {
        std::shuffle(lights.begin(), lights.end(), random.engine());
        const glm::dvec3 again = object_irradiance(lights, point);
        EXPECT_NEAR(again.r, total.r, 4e-16 * std::abs(total.r));
    }
    EXPECT_EQ(object_irradiance({}, point), glm::dvec3(0.0));
}

TEST(Irradiance, ExtremesAreFinite) {
    RandomScene random(6);
    for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::sun, LightKind::area}) {
        for (int i = 0; i < 400; ++i) {
            FlatLight light = random.light();
            light.kind = kind;
            light.power = random.decades(1e-20, 1e20);
            if (random.one_in(4)) light.spot_angle = random.one_in(2) ? 0.0 : pi;
            if (random.one_in(4)) light.spread = random.one_in(2) ? 0.0 : 1e-9;
            if (random.one_in(4)) light.size_x = light.size_y = random.decades(1e-300, 1e300);
            if (random.one_in(4)) light.radius = random.decades(1e-300, 1e300);
            if (random.one_in(8)) light.position *= random.decades(1e-300, 1e300);
            if (random.one_in(8)) light.direction *= random.decades(1e-300, 1e200);
            glm::dvec3 point = random.unit_vector() * random.decades(1e-12, 1e12);
            if (random.one_in(4)) point = light.position;
            if (random.one_in(4)) point = light.position + random.unit_vector() * random.decades(1e-20, 1e-5);
            const glm::dvec3 normal = random.unit_vector();
            const glm::dvec3 one = irradiance_at({light}, point, normal);
            const glm::dvec3 facing = object_irradiance({light}, point);
            const glm::dvec3 surface = surface_irradiance({light}, {&point, 1}, {&normal, 1})[0];
            EXPECT_TRUE(finite(one) && finite(facing) && finite(surface)) << i;
            EXPECT_GE(one.r, 0.0) << i;
            EXPECT_NEAR(surface.r, one.r, 1e-7 * (std::abs(one.r) + std::abs(facing.r))) << i;
        }
    }
}

TEST(Irradiance, ALightAtThePointIsAtTheMinDistance) {
    const FlatLight light = light_at(LightKind::point, 1);
    EXPECT_NEAR(irradiance_at({light}, light.position, {1, 0, 0}).r / (1 / (4 * pi * 1e-12)), 1.0, 1e-12);
    FlatLight panel = light_at(LightKind::area, 1);
    panel.size_x = panel.size_y = 2;
    EXPECT_NEAR(irradiance_at({panel}, panel.position, {0, 0, 1}).r, 0.25,
                1e-5);  // radiance 1 / (4 pi), all of the half sky
}

TEST(Irradiance, LightsThatAreOffAndNegativePower) {
    FlatLight light = light_at(LightKind::point, -100);
    EXPECT_NEAR(irradiance_at({light}, glm::dvec3(0.0), {0, 0, 1}).r, -100 / (16 * pi), 1e-13);
    light.visible = false;
    EXPECT_EQ(object_irradiance({light}, glm::dvec3(0.0)), glm::dvec3(0.0));
}

TEST(Irradiance, TenThousandLightsAtOnePoint) {
    const std::vector<Light> lights(10000, light_at(LightKind::point, 0.01));
    EXPECT_NEAR(object_irradiance(lights, glm::dvec3(0.0)).r, 100 / (16 * pi), 1e-13);
}

TEST(Irradiance, BadInputIsNamed) {
    FlatLight light = light_at(LightKind::spot, 1);
    light.name = "Rim";
    light.spot_blend = 1.5;
    EXPECT_EQ(message_of(light), "light \"Rim\" spot_blend is 1.5; allowed: a number of 0 to 1");
    light.spot_blend = 0.5;
    light.spot_angle = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(message_of(light), "light \"Rim\" spot_angle is nan; allowed: an angle of 0 to pi radians");
    light = light_at(LightKind::area, 1);
    light.size_y = -1;
    EXPECT_EQ(message_of(light), "light size_y is -1; allowed: a finite number, 0 or more");
    light = light_at(LightKind::point, 1e308);
    light.position = glm::dvec3(0.0);
    EXPECT_NE(message_of(light).find("irradiance of light"), std::string::npos);
    EXPECT_THROW(irradiance_at({light_at(LightKind::sun, 1)}, glm::dvec3(0.0), glm::dvec3(0.0)),
                 std::invalid_argument);
    EXPECT_THROW(object_irradiance({}, glm::dvec3(std::nan(""))), std::invalid_argument);
    EXPECT_THROW(object_irradiance({}, glm::dvec3(0.0), 0.0), std::invalid_argument);
}

TEST(LightUnits, AreBlenders) {
    EXPECT_EQ(exposure_factor(3), 8.0);
    EXPECT_THROW(exposure_factor(1e6), std::invalid_argument);
    EXPECT_EQ(legacy_sun_power_factor(0.0), 1.0);
    EXPECT_NEAR(legacy_sun_power_factor(0.6), 0.97714, 5e-5);  // as Cycles 3.4.1 renders it
    EXPECT_THROW(legacy_sun_power_factor(pi), std::invalid_argument);
    // Blender 4.5's temperature_color at 3000 K, as measured.
    const glm::dvec3 warm = black_body_color(3000);
    EXPECT_NEAR(warm.r, 1.7708, 2e-4);
    EXPECT_NEAR(warm.g, 0.8443, 2e-4);
    EXPECT_NEAR(warm.b, 0.2722, 2e-4);
    EXPECT_THROW(black_body_color(100), std::invalid_argument);
    FlatLight light = light_at(LightKind::area, 1);
    light.size_x = 2;
    light.size_y = 3;
    EXPECT_EQ(unnormalized_power_factor(light), 6.0);
    light.area_shape = AreaShape::ellipse;
    EXPECT_NEAR(unnormalized_power_factor(light), 1.5 * pi, 1e-14);
    light = light_at(LightKind::point, 1);
    light.radius = 0.5;
    EXPECT_NEAR(unnormalized_power_factor(light), pi, 1e-14);
}
