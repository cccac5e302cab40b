#include <gtest/gtest.h>
#include <skinglow/rig.h>
#include <skinglow/surface_lighting.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "random_lights.h"
#include "rig/rig_data.h"
#include "rounds.h"

using namespace skinglow;

namespace {

using std::numbers::pi;
const Box head{glm::dvec3(-0.1), glm::dvec3(0.1)};

glm::dvec3 exact(const PreparedRig& lights, const glm::dvec3& point, const glm::dvec3& normal,
                 const SurfaceOptions& options = {}) {
    return surface_irradiance(lights, {&point, 1}, {&normal, 1}, options)[0];
}

/// The largest difference from the exact irradiance over random points and normals, as a fraction of the largest
/// that there is.
double largest_difference(const PreparedRig& lights, const SurfaceLighting& lighting, RandomScene& random,
                          const SurfaceOptions& options = {}) {
    double difference = 0;
    double largest = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 point = random.in_box(head.min, head.max);
        const glm::dvec3 normal = random.unit_vector();
        const glm::dvec3 truth = exact(lights, point, normal, options);
        const glm::dvec3 shown = lighting.irradiance(point, normal);
        for (int c = 0; c < 3; ++c) {
            difference = std::max(difference, std::abs(shown[c] - truth[c]));
            largest = std::max(largest, std::abs(truth[c]));
        }
    }
    return largest > 0 ? difference / largest : difference;
}

}  // namespace

TEST(SurfaceLighting, IsExactForSmallPointsSharpSpotsAndSuns) {
    RandomScene random(3);
    for (std::size_t trial = 0; trial < 60; ++trial) {
        FlatLight light;
        light.kind = std::array{LightKind::point, LightKind::spot, LightKind::sun}[trial % 3];
        light.position = random.unit_vector() * random.decades(0.3, 10);
        light.direction = -light.position + random.unit_vector() * 0.1;
        light.color = random.in_box(glm::dvec3(0.1), glm::dvec3(1));
        light.spot_angle = random.between(0.3, pi);
        light.spot_blend = random.between(0.05, 1);
        light.spot_cosine = trial % 2 == 0;
        light.power = random.decades(0.01, 100);
        const SurfaceLighting lighting({light}, head);
        ASSERT_EQ(lighting.terms().size(), 1U);
        EXPECT_EQ(lighting.plain_terms(), light.kind == LightKind::spot ? 0U : 1U);
        EXPECT_LT(largest_difference({light}, lighting, random), 1e-9) << to_text(light.kind) << trial;
    }
}

TEST(SurfaceLighting, SoftLightsAreWithinTheHorizonsParabola) {
    RandomScene random(4);
    for (int trial = 0; trial < 40; ++trial) {
        FlatLight light;
        light.kind = trial % 2 == 0 ? LightKind::point : LightKind::sun;
        light.position = random.unit_vector();
        light.direction = random.unit_vector();
        light.radius = random.between(0.01, 0.3);
        light.sun_angle = random.between(0.0, 0.6);
        const SurfaceLighting lighting({light}, head);
        EXPECT_LT(largest_difference({light}, lighting, random), 0.02) << trial;
    }
}

TEST(SurfaceLighting, CutsNearAreaLightsUntilTheyFit) {
    RandomScene random(5);
    FlatLight light;
    light.kind = LightKind::area;
    light.position = {0.0, 0.0, 0.6};
    light.direction = {0.0, 0.0, -1.0};
    for (const AreaShape shape : {AreaShape::rectangle, AreaShape::ellipse}) {
        light.area_shape = shape;
        light.size_x = 0.8;
        light.size_y = 0.4;
        const SurfaceLighting one({light}, head, {.max_terms = 1});
        const SurfaceLighting many({light}, head, {.max_terms = 16, .tolerance = 1e-3});
        EXPECT_EQ(one.terms().size(), 1U);
        EXPECT_GT(many.terms().size(), 2U);
        const double coarse = largest_difference({light}, one, random);
        const double fine = largest_difference({light}, many, random);
        EXPECT_LT(fine, 0.5 * coarse);
        EXPECT_LT(fine, 0.03);
        light.size_x = light.size_y = 0.02;
        const SurfaceLighting small({light}, head, {.max_terms = 16});
        EXPECT_EQ(small.terms().size(), 1U);
        EXPECT_LT(largest_difference({light}, small, random), 0.01);
    }
}

TEST(SurfaceLighting, TilesAddUpToTheLight) {
    FlatLight light;
    light.kind = LightKind::area;
    light.position = {0.0, 0.0, 50.0};
    light.size_x = 1.0;
    light.size_y = 0.5;
    light.spread = 2.0;
    const PreparedLight prepared(light);
    const glm::dvec3 truth = irradiance_at({light}, glm::dvec3(0.0), {0.0, 0.0, 1.0});
    for (const auto& [columns, rows] : {std::pair(1, 1), std::pair(2, 1), std::pair(4, 4)}) {
        glm::dvec3 sum(0.0);
        for (const SurfaceTerm& term :
             surface_terms(prepared, glm::dvec3(1.0), glm::dvec3(0.0), columns, rows))
            sum += term.irradiance(glm::dvec3(0.0), {0.0, 0.0, 1.0}, lambert_cubic);
        EXPECT_NEAR(sum.g / truth.g, 1.0, 5e-3) << columns << "x" << rows;
    }
}

TEST(SurfaceLighting, LightsBeyondTheTermsShineFromFarAway) {
    RandomScene random(6);
    std::vector<FlatLight> lights(40);
    for (FlatLight& light : lights) {
        light.position = random.unit_vector() * random.between(2, 4);
        light.power = random.between(0.5, 1);
    }
    const SurfaceLighting lighting(made(lights), head, {.max_terms = 8});
    EXPECT_EQ(lighting.terms().size(), 8U);
    EXPECT_EQ(lighting.far_lights().size(), 32U);
    EXPECT_LT(largest_difference(made(lights), lighting, random), 0.06);
}

TEST(SurfaceLighting, NegativeLightsBeyondTheTermsTakeLightAway) {
    // Eight bright lights have the terms; seven that nearly undo them are in the polynomial.
    std::vector<FlatLight> lights(15);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].position = {0.01 * static_cast<double>(i), 0.0, 3.0};
        lights[i].power = i < 8 ? 10.0 : -9.9;
    }
    const SurfaceLighting lighting(made(lights), head, {.max_terms = 8});
    ASSERT_EQ(lighting.far_lights().size(), 7U);
    const double truth = exact(made(lights), glm::dvec3(0.0), {0, 0, 1}).r;
    const double bright = exact(made({lights.begin(), lights.begin() + 8}), glm::dvec3(0.0), {0, 0, 1}).r;
    // By nine harmonics a light is off by some hundredths of its own.
    EXPECT_NEAR(lighting.irradiance(glm::dvec3(0.0), {0, 0, 1}).r, truth, 0.1 * bright);
    // What is shown is never below 0.
    lights[14].power = -100.0;
    const SurfaceLighting dark(made(lights), head, {.max_terms = 8});
    EXPECT_EQ(dark.irradiance(glm::dvec3(0.0), {0, 0, 1}).r, 0.0);
}

TEST(SurfaceLighting, TheWorldIsAsTheEnvironmentSays) {
    RandomScene random(7);
    std::array<glm::dvec3, 9> harmonics{};
    for (glm::dvec3& c : harmonics) c = random.unit_vector() * 0.1;
    harmonics[0] = glm::dvec3(2.0);
    const Environment environment(harmonics);
    const AngularWeight weight = skin_angular_weight(Tissue{});
    const SurfaceLighting lighting({}, head, {.environment = &environment, .angular_weight = &weight});
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 normal = random.unit_vector();
        EXPECT_NEAR(glm::distance(lighting.irradiance(glm::dvec3(0.0), normal),
                                  environment.irradiance(normal, &weight)),
                    0.0, 1e-12);
    }
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 off =
            glm::abs(environment.irradiance(random.unit_vector()) - environment.mean_irradiance());
        for (int c = 0; c < 3; ++c) EXPECT_LE(off[c], environment.mean_irradiance_error()[c]);
    }
    const Environment even(glm::dvec3(0.25));
    EXPECT_EQ(even.mean_irradiance_error(), glm::dvec3(0.0));
    EXPECT_NEAR(SurfaceLighting({}, head, {.environment = &even}).irradiance(glm::dvec3(0.0), {1, 0, 0}).r,
                pi * 0.25, 1e-12);
}

TEST(SurfaceLighting, AngularWeightOfSkinIsNearlyACubic) {
    RandomScene random(8);
    for (const TissuePreset& preset : tissue_presets()) {
        const AngularWeight weight = skin_angular_weight(preset.tissue);
        const AngularCubic cubic = weight.cubic();
        double diffuse = 0;
        for (int i = 0; i <= 1000; ++i) {
            const double mu = i / 1000.0;
            diffuse += 2.0 * mu * evaluate(cubic, mu).g * (i == 0 || i == 1000 ? 0.5 : 1.0) / 1000.0;
            const glm::dvec3 off = mu * (evaluate(cubic, mu) - weight.at(mu));
            for (int c = 0; c < 3; ++c) EXPECT_LT(std::abs(off[c]), 0.01) << preset.name << " " << mu;
        }
        EXPECT_NEAR(diffuse, 1.0, 1e-5) << preset.name;
    }
    FlatLight light;
    light.position = {0.0, 0.5, 0.5};
    const AngularWeight weight = skin_angular_weight(Tissue{});
    const SurfaceLighting lighting({light}, head, {.angular_weight = &weight});
    SurfaceOptions options;
    options.angular_weight = &weight;
    EXPECT_LT(largest_difference({light}, lighting, random, options), 0.01);
}

TEST(SurfaceLighting, AnglesHardlyDependOnThickness) {
    const AngularWeight thin = skin_angular_weight(Tissue{}, 2.0);
    const AngularWeight thick = skin_angular_weight(Tissue{}, 10.0);
    for (double mu = 0.05; mu <= 1.0; mu += 0.05) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mu * thin.at(mu)[c], mu * thick.at(mu)[c], 0.005);
    }
    EXPECT_THROW(skin_angular_weight(Tissue{}, 0.0), std::invalid_argument);
}

TEST(SurfaceLighting, SurvivesWhateverLightsThereAre) {
    RandomScene random(9);
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<FlatLight> lights;
        for (int i = 0; i < 12; ++i) {
            FlatLight& light = lights.emplace_back(random.light());
            if (random.one_in(6)) light.position = glm::dvec3(0.0);
            if (random.one_in(6)) light.position *= 1e20;
            if (random.one_in(6)) light.power *= random.decades(1e-20, 1e20);
            if (random.one_in(6)) light.spot_angle = 0.0;
            if (random.one_in(6)) light.sun_angle = pi;
            if (random.one_in(6)) light.spread = 1e-3;
        }
        const SurfaceLighting lighting(made(lights), head);
        EXPECT_LE(lighting.terms().size(), 8U);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 point = i == 0 ? lights[0].position : random.in_box(head.min, head.max);
            const glm::dvec3 shown = lighting.irradiance(point, random.unit_vector());
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(shown[c])) << trial;
        }
    }
    const SurfaceLighting nothing({}, head);
    EXPECT_TRUE(nothing.terms().empty());
    EXPECT_EQ(nothing.irradiance(glm::dvec3(0.0), {0, 0, 1}), glm::dvec3(0.0));
    EXPECT_THROW(SurfaceLighting({}, Box{glm::dvec3(1.0), glm::dvec3(0.0)}), std::invalid_argument);
    EXPECT_THROW(SurfaceLighting({}, head, {.tolerance = 0.0}), std::invalid_argument);
}

TEST(ObjectWeightError, HoldsForEveryPointAndNormalOfTheCone) {
    RandomScene random(10);
    int tight = 0;
    for (int trial = 0; trial < rounds(400); ++trial) {
        const std::vector<Light> lights = random.lights(1 + trial % 4);
        const NormalCone cone{random.unit_vector(), random.between(0, 1.5)};
        const glm::dvec3 here = object_irradiance(lights, head.center());
        const glm::dvec3 bound = object_irradiance_error(lights, head.center(), head, cone);
        for (int i = 0; i < 60; ++i) {
            const glm::dvec3 point = random.in_box(head.min, head.max);
            const glm::dvec3 side = glm::normalize(glm::cross(cone.axis, random.unit_vector()));
            const double angle = random.between(0, cone.half_angle);
            const glm::dvec3 normal = std::cos(angle) * cone.axis + std::sin(angle) * side;
            const glm::dvec3 off = glm::abs(exact(lights, point, normal) - here);
            for (int c = 0; c < 3; ++c) EXPECT_LE(off[c], bound[c] * (1 + 1e-9) + 1e-15) << trial;
        }
        if (bound.g < here.g) ++tight;
    }
    EXPECT_GT(tight, rounds(20));
}

TEST(ObjectWeightError, IsSmallForAFlatPatchThatFacesADistantLight) {
    FlatLight light;
    light.position = {0.0, 0.0, 100.0};
    light.power = 1000.0;
    const Box flat{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.0}};
    const NormalCone up = normal_cone(std::vector<glm::dvec3>{{0, 0, 2.0}, {0, 0, 1.0}});
    EXPECT_EQ(up.half_angle, 0.0);
    EXPECT_LT(object_irradiance_error({light}, flat.center(), flat, up).g,
              1e-3 * object_irradiance({light}, flat.center()).g);
    EXPECT_EQ(normal_cone(std::vector<glm::dvec3>{{0, 0, 1}, {0, 0, -1}}).half_angle, pi);
    EXPECT_EQ(normal_cone({}).half_angle, pi);
}
