#include "radiometry/area_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "random_lights.h"

using namespace skinglow;

namespace {

using std::numbers::pi;
constexpr double tolerance = 1e-9;
const glm::dvec3 down(0, 0, -1);

/// The definition: radiance times both cosines over the squared distance, summed over small pieces of
/// the light.
double by_quadrature(const AreaEmitter& emitter, const glm::dvec3& point, const glm::dvec3& normal,
                     int pieces) {
    const bool round = emitter.shape() == AreaShape::ellipse;
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        for (int k = 0; k < pieces; ++k) {
            const double u = (i + 0.5) / pieces;
            const double v = (k + 0.5) / pieces;
            const double phi = 2 * pi * v;
            const glm::dvec3 on_light =
                round ? glm::dvec3(emitter.half_x() * std::sqrt(u) * std::cos(phi),
                                   emitter.half_y() * std::sqrt(u) * std::sin(phi), 0)
                      : glm::dvec3(emitter.half_x() * (2 * u - 1), emitter.half_y() * (2 * v - 1), 0);
            const glm::dvec3 offset = on_light - point;
            const double distance_sq = glm::dot(offset, offset);
            const double cosine = -offset.z / std::sqrt(distance_sq);
            const double tangent = std::sqrt(offset.x * offset.x + offset.y * offset.y) / -offset.z;
            sum += emitter.gain(tangent) * cosine * std::max(0.0, glm::dot(normal, offset)) /
                   (distance_sq * std::sqrt(distance_sq));
        }
    }
    return sum * emitter.area() / pieces / pieces;
}

/// A parallel rectangle, seen from under one of its corners: view factor of every heat-transfer handbook,
/// times pi.
double corner_of_parallel_rectangle(double width, double length, double height) {
    const double x = width / height;
    const double y = length / height;
    const double p = std::sqrt(1 + x * x);
    const double q = std::sqrt(1 + y * y);
    return 0.5 * (x / p * std::atan(y / p) + y / q * std::atan(x / q));
}

/// A parallel disk, seen from a distance to its axis: exact for every on_light.
double parallel_disk(double radius, double aside, double height) {
    const double s = aside * aside + height * height + radius * radius;
    return 0.5 * pi *
           (1 - (s - 2 * radius * radius) / std::sqrt(s * s - 4 * aside * aside * radius * radius));
}

}  // namespace

TEST(AreaIrradiance, ParallelRectangleHasItsClosedForm) {
    const AreaEmitter emitter(AreaShape::rectangle, 1.0, 0.5, pi);
    for (const double h : {1e-3, 0.1, 1.0, 30.0}) {
        EXPECT_NEAR(
            emitter.irradiance({0, 0, h}, down, tolerance) / (4 * corner_of_parallel_rectangle(1.0, 0.5, h)),
            1.0, 1e-9);
        EXPECT_NEAR(
            emitter.irradiance({1.0, 0.5, h}, down, tolerance) / corner_of_parallel_rectangle(2.0, 1.0, h),
            1.0, 1e-9);
    }
}

TEST(AreaIrradiance, ParallelDiskHasItsClosedForm) {
    const AreaEmitter emitter(AreaShape::ellipse, 1.0, 1.0, pi);
    for (const double h : {1e-3, 0.1, 1.0, 30.0}) {
        for (const double aside : {0.0, 0.5, 0.999, 1.0, 1.001, 3.0}) {
            const double expected = parallel_disk(1.0, aside, h);
            EXPECT_NEAR(emitter.irradiance({aside * 0.6, aside * 0.8, h}, down, tolerance), expected,
                        1e-7 * expected + 1e-10)
                << h << " " << aside;
        }
    }
}

TEST(AreaIrradiance, TiltedReceiversAgreeWithTheDefinition) {
    RandomScene random(1);
    for (int i = 0; i < 24; ++i) {
        const AreaEmitter emitter(random.one_in(2) ? AreaShape::ellipse : AreaShape::rectangle, 1.0,
                                  random.between(0.1, 1.0), random.one_in(2) ? pi : random.between(0.6, 3.0));
        const glm::dvec3 point(random.between(-1.5, 1.5), random.between(-1.5, 1.5),
                               random.between(0.4, 2.0));
        const glm::dvec3 normal = random.unit_vector();
        const double expected = by_quadrature(emitter, point, normal, 500);
        EXPECT_NEAR(emitter.irradiance(point, normal, tolerance), expected, 2e-5) << i;
    }
}

TEST(AreaIrradiance, HorizonCutsTheLightExactly) {
    // The horizon runs through the center, so what is left is a rectangle, or half a disk, of its own.
    const glm::dvec3 normal(1, 0, 0);
    const AreaEmitter whole(AreaShape::rectangle, 1.0, 0.7, pi);
    const AreaEmitter half(AreaShape::rectangle, 0.5, 0.7, pi);
    const AreaEmitter spread_whole(AreaShape::rectangle, 1.0, 0.7, 2.0);
    const AreaEmitter spread_half(AreaShape::rectangle, 0.5, 0.7, 2.0);
    for (const double h : {0.05, 0.4, 3.0}) {
        const glm::dvec3 from_half(-0.5, 0.2, h);  // the half's center stands at x = 0.5
        EXPECT_NEAR(whole.irradiance({0, 0.2, h}, normal, tolerance),
                    half.irradiance(from_half, normal, tolerance), 1e-12);
        EXPECT_NEAR(spread_whole.irradiance({0, 0.2, h}, normal, tolerance),
                    spread_half.irradiance(from_half, normal, tolerance), 1e-8);
        // A disk seen edge on from its axis: half of the integral of the definition, in closed form along
        // each radius.
        const AreaEmitter disk(AreaShape::ellipse, 1.0, 1.0, pi);
        const double expected = std::atan(1 / h) - h / (1 + h * h);
        EXPECT_NEAR(disk.irradiance({0, 0, h}, normal, tolerance), expected, 1e-8);
    }
}

TEST(AreaIrradiance, SpreadKeepsThePowerAndIsDarkBeyondItsAngle) {
    for (const double spread : {0.01, 0.5, 2.0, 3.1}) {
        const double half = 0.5 * spread;
        const AreaEmitter emitter(AreaShape::rectangle, 1e-4, 1e-4, spread);
        // Far away, over the sphere: the power per radiance is pi times the area, whatever the spread.
        double sum = 0;
        constexpr int steps = 2000;
        for (int i = 0; i < steps; ++i) {
            const double t = half * (i + 0.5) / steps;
            const glm::dvec3 direction(std::sin(t), 0, std::cos(t));
            const double value = emitter.irradiance(100.0 * direction, -direction, tolerance);
            sum += value * 1e4 * 2 * pi * std::sin(t) * half / steps;
        }
        EXPECT_NEAR(sum / (pi * emitter.area()), 1.0, 1e-4) << spread;
        const double beyond = half + 1e-3;
        if (beyond < pi / 2) {
            EXPECT_EQ(emitter.irradiance(glm::dvec3(std::sin(beyond), 0, std::cos(beyond)) * 100.0, down,
                                         tolerance),
                      0.0);
        }
    }
}

TEST(AreaIrradiance, SpreadOnTheAxisOfADiskHasAClosedForm) {
    for (const double spread : {0.2, 1.0, 2.5}) {
        const AreaEmitter emitter(AreaShape::ellipse, 1.0, 1.0, spread);
        const double t = std::tan(0.5 * spread);
        for (const double h : {0.2, 1.0, 5.0}) {
            const double x = std::min(1 / h, t);
            const double first = 0.5 * x * x / (1 + x * x);
            const double second = 0.5 * (std::atan(x) - x / (1 + x * x));
            const double expected = 2 * pi * (t * first - second) / (t - 0.5 * spread);
            EXPECT_NEAR(emitter.irradiance({0, 0, h}, down, tolerance) / expected, 1.0, 1e-7)
                << spread << " " << h;
        }
    }
}
