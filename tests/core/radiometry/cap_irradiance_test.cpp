#include "radiometry/cap_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "random_lights.h"

using namespace skinglow;

namespace {

using std::numbers::pi;

/// The same by brute force: rings around the center of the patch, each with the closed-form arc above the
/// horizon left out, so that nothing is shared with the code under test.
double cap_by_quadrature(const SpotProfile* profile, const glm::dvec3& normal, const glm::dvec3& to_light,
                         const glm::dvec3& to_spot, double sin_radius) {
    const glm::dvec3 side = glm::normalize(
        glm::cross(to_light, std::abs(to_light.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 other = glm::cross(to_light, side);
    constexpr int rings = 600;
    constexpr int steps = 1200;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double radius_sq = (i + 0.5) / rings;  // equal areas of the projected disk
        const double sine = sin_radius * std::sqrt(radius_sq);
        const double cosine = std::sqrt(1 - sine * sine);
        for (int k = 0; k < steps; ++k) {
            const double phi = 2 * pi * (k + 0.5) / steps;
            const glm::dvec3 direction =
                cosine * to_light + sine * (std::cos(phi) * side + std::sin(phi) * other);
            const double falloff = profile == nullptr ? 1.0 : profile->at(glm::dot(direction, to_spot));
            sum += falloff * std::max(0.0, glm::dot(normal, direction)) / cosine;
        }
    }
    return sum / (rings * steps);
}

}  // namespace

TEST(CapIrradiance, IsTheCosineAboveTheHorizonAndNothingBelow) {
    EXPECT_EQ(cap_irradiance(0.5, 0.3), 0.5);
    EXPECT_EQ(cap_irradiance(1.0, 1.0), 1.0);
    EXPECT_EQ(cap_irradiance(-0.5, 0.3), 0.0);
    EXPECT_EQ(cap_irradiance(0.25, 0.0), 0.25);
    EXPECT_EQ(cap_irradiance(-0.25, 0.0), 0.0);
}

TEST(CapIrradiance, HalfTheSkyHasAClosedForm) {
    for (const double c : {-0.999, -0.5, 0.0, 0.3, 0.999})
        EXPECT_NEAR(cap_irradiance(c, 1.0), 0.5 * (1 + c), 1e-14);
}

TEST(CapIrradiance, AgreesWithQuadratureAcrossTheHorizon) {
    for (const double radius : {0.05, 0.5, 1.2}) {
        for (const double tilt : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
            const double angle = pi / 2 - tilt * radius;
            const glm::dvec3 normal(std::sin(angle), 0, std::cos(angle));
            const double expected =
                cap_by_quadrature(nullptr, normal, {0, 0, 1}, {0, 0, 1}, std::sin(radius));
            EXPECT_NEAR(cap_irradiance(normal.z, std::sin(radius)), expected, 3e-6) << radius << " " << tilt;
        }
    }
}

TEST(CapIrradiance, IsContinuousWhereFormsMeetAndFallsWithTheAngle) {
    for (const double sine : {1e-300, 1e-9, 1e-4, 0.01, 0.0499, 0.0501, 0.7, 1.0}) {
        EXPECT_NEAR(cap_irradiance(sine * (1 - 1e-9), sine), sine, 1e-8 * sine + 1e-11);
        EXPECT_NEAR(cap_irradiance(-sine * (1 - 1e-9), sine), 0.0, 1e-8 * sine + 1e-11);
        double before = 2;
        for (int i = 0; i <= 200; ++i) {
            const double value = cap_irradiance(std::cos(pi * i / 200), sine);
            EXPECT_LE(value, before + 1e-11);
            before = value;
        }
    }
    EXPECT_NEAR(cap_irradiance(0.3e-4, 0.999999e-4), cap_irradiance(0.3e-4, 1.000001e-4), 1e-10);
}

TEST(SpotProfile, IsASmoothstepInTheCosine) {
    const SpotProfile spot(1.2, 0.25, false);
    const double edge = std::cos(0.6);
    EXPECT_EQ(spot.at(edge), 0.0);
    EXPECT_EQ(spot.at(edge - 0.1), 0.0);
    EXPECT_EQ(spot.at(1.0), 1.0);
    EXPECT_NEAR(spot.at(edge + 0.125 * (1 - edge)), 0.5, 1e-12);
    EXPECT_NEAR(spot.at(edge + 0.0625 * (1 - edge)), 3.0 / 16 - 2.0 / 64, 1e-12);
    EXPECT_NEAR(std::cos(spot.fade_start()), edge + 0.25 * (1 - edge), 1e-14);
    EXPECT_NEAR(SpotProfile(1.2, 0.25, true).at(0.95), 0.95, 1e-15);
}

TEST(SpotProfile, ThroughASoftLightAgreesWithQuadrature) {
    RandomScene random(3);
    for (int i = 0; i < 12; ++i) {
        const SpotProfile spot(random.between(0.2, pi), random.between(0.1, 1.0), random.one_in(3));
        const glm::dvec3 to_light = random.unit_vector();
        const glm::dvec3 to_spot = glm::normalize(to_light + random.unit_vector() * random.between(0.0, 0.7));
        const glm::dvec3 normal = glm::normalize(to_light + random.unit_vector() * random.between(0.0, 2.0));
        const double sine = random.between(0.05, 0.95);
        const double expected = cap_by_quadrature(&spot, normal, to_light, to_spot, sine);
        EXPECT_NEAR(cap_irradiance_through_spot(spot, normal, to_light, to_spot, sine), expected, 2e-5) << i;
    }
}

TEST(SpotProfile, WideOpenItIsTheLightItself) {
    const SpotProfile spot(pi, 0.0, false);
    RandomScene random(4);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 to_light = random.unit_vector();
        const glm::dvec3 normal = random.unit_vector();
        const double sine = random.between(1e-3, 0.3);
        // The whole light is inside the half space that a cone of 180 degrees lights.
        const glm::dvec3 to_spot = glm::normalize(to_light + random.unit_vector() * 0.5);
        const double expected = cap_irradiance(glm::dot(normal, to_light), sine);
        EXPECT_NEAR(cap_irradiance_through_spot(spot, normal, to_light, to_spot, sine), expected, 1e-7) << i;
    }
}
