#include <gtest/gtest.h>
#include <skinglow/angular_weight.h>
#include <skinglow/environment.h>
#include <skinglow/rig.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "each_vector_target.h"
#include "random_lights.h"
#include "rounds.h"

using namespace skinglow;

namespace {

using std::numbers::pi;

struct Surface {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
};

Surface random_surface(RandomScene& random, std::size_t count) {
    Surface surface;
    for (std::size_t i = 0; i < count; ++i) {
        surface.points.push_back(random.in_box(glm::dvec3(-0.5), glm::dvec3(0.5)));
        surface.normals.push_back(random.unit_vector() * random.decades(0.01, 100));
    }
    return surface;
}

}  // namespace

/// Of one light at a point, relative to what it gives there: what rounding does to the kernels, and the integrals'
/// tolerance for lights without one.
double kernel_error(const FlatLight& light, const glm::dvec3& point) {
    if (light.kind == LightKind::spot) {
        const double fade = light.spot_blend * (1 - std::cos(0.5 * light.spot_angle));
        return 1e-14 * (1 + (fade > 0 ? 1 / fade : 0));
    }
    if (light.kind != LightKind::area) return 1e-14;
    const double area = light.size_x * light.size_y;
    if (light.area_shape == AreaShape::ellipse || light.spread < pi || area == 0.0) return 1e-8;
    // Opposite edges nearly cancel where a light is far or thin.
    return 2e-14 * (1 + glm::distance(light.position, point) * std::max(light.size_x, light.size_y) / area);
}

TEST(SurfaceIrradiance, IsTheSumOfIrradianceForEveryKindAndPoint) {
    for_each_vector_target([] {
        RandomScene random(7);
        for (int trial = 0; trial < rounds(60); ++trial) {
            const Surface surface = random_surface(random, 61);
            const FlatLight light = random.light();
            const auto all = surface_irradiance({light}, surface.points, surface.normals);
            for (std::size_t i = 0; i < all.size(); ++i) {
                const double one = irradiance_at({light}, surface.points[i], surface.normals[i]).g;
                const double scale =
                    std::abs(object_irradiance({light}, surface.points[i]).g) + std::abs(one);
                EXPECT_NEAR(all[i].g, one, kernel_error(light, surface.points[i]) * scale)
                    << to_text(light.kind) << " " << trial << " " << i;
            }
        }
    });
}

/// Lambert's formula for a rectangle of 1 by 0.6 at the origin that shines along -z, seen whole; by any arc tangent.
template <class ArcTangent>
double by_lambert(const glm::dvec3& point, const glm::dvec3& normal, const ArcTangent& atan) {
    const glm::dvec3 corner[] = {{-0.5, -0.3, 0}, {0.5, -0.3, 0}, {0.5, 0.3, 0}, {-0.5, 0.3, 0}};
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 a = corner[i] - point;
        const glm::dvec3 b = corner[(i + 1) % 4] - point;
        const glm::dvec3 across = glm::cross(a, b);
        const double y = glm::length(across);
        const double x = glm::dot(a, b);
        const double t = std::min(y, std::abs(x)) / std::max(y, std::abs(x));
        const double octant = y < std::abs(x) ? atan(t) : 0.5 * pi - atan(t);
        sum += 0.5 * (x < 0 ? pi - octant : octant) * glm::dot(normal, across) / y;
    }
    return std::abs(sum) / (pi * 0.6);
}

TEST(SurfaceIrradiance, ARectangleIsExactToRoundingAndAWrongArcTangentWouldShow) {
    FlatLight light;
    light.kind = LightKind::area;
    light.size_x = 1.0;
    light.size_y = 0.6;
    RandomScene random(9);
    Surface surface;
    for (int i = 0; i < 500; ++i) {
        surface.points.push_back(random.in_box({-1, -1, -2}, {1, 1, -0.2}));
        surface.normals.push_back(glm::normalize(glm::dvec3(0.1, -0.05, 1) * 3.0 - surface.points.back()));
    }
    for_each_vector_target([&] {
        const auto found = surface_irradiance({light}, surface.points, surface.normals);
        double error = 0;
        double seen = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const auto& point = surface.points[i];
            const auto& normal = surface.normals[i];
            // Whole above the horizon.
            if (-glm::dot(normal, point) <= 0.5 * std::abs(normal.x) + 0.3 * std::abs(normal.y)) continue;
            const double exact = by_lambert(point, normal, [](double t) { return std::atan(t); });
            const double wrong =
                by_lambert(point, normal, [](double t) { return std::atan(t) + 1e-12 * std::pow(t, 9); });
            error = std::max(error, std::abs(found[i].g - exact) / exact);
            seen = std::max(seen, std::abs(wrong - exact) / exact);
        }
        EXPECT_LE(error, 1e-13);
        EXPECT_GT(seen, 2e-13);  // so a coefficient wrong by 1e-12 is above the bound
    });
}

TEST(SurfaceIrradiance, ASunAcrossTheHorizonIsExactToRounding) {
    RandomScene random(10);
    for (int trial = 0; trial < 60; ++trial) {
        FlatLight light;
        light.kind = LightKind::sun;
        light.sun_angle = random.decades(1e-7, 0.3);  // those up to 0.1 by the kernel's own formula
        const double radius = std::sin(0.5 * light.sun_angle);
        const glm::dvec3 across = random.unit_vector();
        light.direction = glm::normalize(glm::cross(across, random.unit_vector()));
        Surface surface;
        for (int i = 0; i < 61; ++i) {
            const double cosine = random.between(-1.2, 1.2) * radius;
            surface.points.emplace_back(0.0);
            surface.normals.push_back(std::sqrt(1 - cosine * cosine) * across - cosine * light.direction);
        }
        for_each_vector_target([&] {
            const auto all = surface_irradiance({light}, surface.points, surface.normals);
            for (std::size_t i = 0; i < all.size(); ++i) {
                const double one = irradiance_at({light}, surface.points[i], surface.normals[i]).g;
                // A cosine that is rounded otherwise, and the formula: a few ulp, by the system's own functions.
                EXPECT_NEAR(all[i].g, one, light.power * (2e-15 + 2e-15 * radius))
                    << light.sun_angle << " " << i;
            }
        });
    }
}

TEST(SurfaceIrradiance, AddsLightsAndEnvironmentOnAnyNumberOfThreads) {
    RandomScene random(8);
    const Surface surface = random_surface(random, static_cast<std::size_t>(rounds(1000)));
    const std::vector<Light> lights = random.lights(20);
    const Environment environment(glm::dvec3(0.1, 0.2, 0.3));
    SurfaceOptions options{.environment = &environment, .threads = 1};
    const std::vector<glm::dvec3> alone =
        surface_irradiance(lights, surface.points, surface.normals, options);
    options.threads = 4;
    EXPECT_EQ(surface_irradiance(lights, surface.points, surface.normals, options), alone);
    glm::dvec3 expected(pi * 0.1, pi * 0.2, pi * 0.3);
    expected += irradiance_at(lights, surface.points[17], surface.normals[17]);
    EXPECT_NEAR(alone[17].b, expected.b, 1e-9 * std::abs(expected.b) + 1e-9);
}

TEST(SurfaceIrradiance, FarSideIsBehindTheVertexAndFacesAway) {
    FlatLight light;
    light.power = 4 * pi;
    light.position = {0, 0, -3};
    const std::vector<glm::dvec3> vertices = {{0, 0, 1}, {0, 0, 1}};
    const std::vector<glm::dvec3> normals = {{0, 0, 5}, {0, 0, -5}};
    const std::vector<double> depth = {2.0, 2.0};
    const std::vector<glm::dvec3> values = far_side_irradiance({light}, vertices, normals, depth);
    EXPECT_NEAR(values[0].r, 1.0 / 4, 1e-14);  // from z = -1, looking down
    EXPECT_EQ(values[1].r, 0.0);               // from z = 3, looking up
    EXPECT_EQ(far_side_irradiance({light}, vertices, normals, std::vector<double>{2.0}), values);
}

TEST(SurfaceIrradiance, NothingInNothingOutAndBadInputIsNamed) {
    EXPECT_TRUE(surface_irradiance({}, {}, {}).empty());
    const std::vector<glm::dvec3> one = {glm::dvec3(0.0)};
    const FlatLight light;
    EXPECT_EQ(surface_irradiance({light}, one, one)[0], glm::dvec3(0.0));  // a normal of 0 faces nowhere
    EXPECT_THROW(surface_irradiance({}, one, {}), std::invalid_argument);
    EXPECT_THROW(far_side_irradiance({}, one, one, std::vector<double>{-1.0}), std::invalid_argument);
    try {
        surface_irradiance({}, std::vector<glm::dvec3>{{0, 0, 0}, {0, NAN, 0}},
                           std::vector<glm::dvec3>(2, {0, 0, 1}));
        FAIL() << "NaN was taken";
    } catch (const std::invalid_argument& error) {
        EXPECT_EQ(std::string(error.what()), "points[1] is (0, nan, 0); allowed: three finite numbers");
    }
}

TEST(AngularWeight, AWideLightCountsByTheAnglesOfItsParts) {
    // Steep enough to tell the center of the light from its rim.
    const AngularWeight weight(std::vector<double>{0.0, 1.0}, std::vector<double>{0.0, 1.0});
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    for (int i = 0; i < 12; ++i) {
        points.emplace_back(0.05 * i, 0.0, 0.01 * i);
        normals.push_back(glm::normalize(glm::dvec3(std::sin(0.4 * i), 0.3, 1.0)));
    }
    const SurfaceOptions options{.angular_weight = &weight};
    for (const double height : {0.4, 1.5, 12.0}) {
        FlatLight whole;
        whole.kind = LightKind::area;
        whole.position = {0, 0, height};
        whole.direction = {0, 0, -1};
        whole.tangent = {1, 0, 0};
        whole.size_x = 0.8;
        whole.size_y = 0.6;
        constexpr int across = 30;
        std::vector<FlatLight> parts(across * across, whole);
        for (int i = 0; i < across * across; ++i) {
            FlatLight& part = parts[static_cast<std::size_t>(i)];
            part.size_x /= across;
            part.size_y /= across;
            part.power /= across * across;
            part.position.x += whole.size_x * ((i % across + 0.5) / across - 0.5);
            part.position.y += whole.size_y * ((i / across + 0.5) / across - 0.5);
        }
        const auto at_once = surface_irradiance({whole}, points, normals, options);
        const auto in_parts = surface_irradiance(made(parts), points, normals, options);
        double largest = 0;
        for (const glm::dvec3& e : in_parts) largest = std::max(largest, e.r);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(at_once[i].r, in_parts[i].r, 5e-3 * largest) << "height " << height << " point " << i;
        }
    }
}

TEST(AngularWeight, KeepsDiffuseLightAndTurnsTheRest) {
    const std::vector<double> mu = {0.0, 0.25, 1.0};
    const std::vector<double> transmittance = {0.1, 0.4, 0.5};
    const AngularWeight weight(mu, transmittance);
    EXPECT_NEAR(weight.band_factors()[0].r, pi, 1e-12);
    EXPECT_NEAR(weight.at(1.0).r / weight.at(0.25).r, 0.5 / 0.4, 1e-12);
    double diffuse = 0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps;
        diffuse += 2 * x * weight.at(x).g / steps;
    }
    EXPECT_NEAR(diffuse, 1.0, 1e-6);
    const Environment even(glm::dvec3(2.0));
    EXPECT_NEAR(even.irradiance({0, 0, 1}, &weight).b, 2 * pi, 1e-12);

    FlatLight light;
    light.position = {0, 0, 1};
    const std::vector<glm::dvec3> point = {glm::dvec3(0.0)};
    const std::vector<glm::dvec3> normal = {{0, std::sqrt(0.91), 0.3}};
    const double plain = surface_irradiance({light}, point, normal)[0].r;
    const double weighted = surface_irradiance({light}, point, normal, {.angular_weight = &weight})[0].r;
    EXPECT_NEAR(weighted / plain, weight.at(0.3).r, 1e-12);
    const AngularWeight flat(std::vector<double>{0.5}, std::vector<double>{7.0});
    EXPECT_NEAR(surface_irradiance({light}, point, normal, {.angular_weight = &flat})[0].r, plain, 1e-15);
    EXPECT_THROW(AngularWeight(mu, std::vector<double>{1.0, 2.0}), std::invalid_argument);
    EXPECT_THROW(AngularWeight(mu, std::vector<double>(3, 0.0)), std::invalid_argument);
    EXPECT_THROW(AngularWeight(std::vector<double>{0.5, 0.5}, std::vector<double>{1.0, 2.0}),
                 std::invalid_argument);
}

TEST(AngularWeight, TheCubicOfASteepWeightIsNeverBelow0) {
    // The least-squares cubic itself is -0.11 where the weight is 0.
    const AngularWeight weight(std::vector<double>{0.0, 0.3, 0.31, 1.0},
                               std::vector<double>{0.0, 0.0, 1.0, 1.0});
    const AngularCubic cubic = weight.cubic();
    double lowest = 1;
    for (int i = 0; i <= 100; ++i) {
        const double mu = 0.01 * i;
        EXPECT_GE(evaluate(cubic, mu).r, 0.0) << mu;
        lowest = std::min(lowest, cubic[0].r + mu * (cubic[1].r + mu * (cubic[2].r + mu * cubic[3].r)));
    }
    EXPECT_LT(lowest, -0.05);
}
