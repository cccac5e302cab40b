#include <gtest/gtest.h>
#include <skinglow/box.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "flat_light.h"
#include "geometry/vector.h"
#include "rays/visible_fraction.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int samples = 200000;
constexpr std::size_t bins = 10;  // along each of the two coordinates
/// Of 99 degrees of freedom: exceeded by one sound sampler in a million.
constexpr double chi_square_limit = 176.0;

/// Chi-square of counts that should all be equal, of points of the unit square. The uniform numbers are a
/// fixed sequence.
template <typename ToSquare>
double chi_square(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                  ToSquare to_square) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> counts(bins * bins, 0.0);
    const LightSampler sampler(light, point, normal);
    for (int i = 0; i < samples; ++i) {
        const double u = uniform(random);
        const glm::dvec2 where = to_square(sampler.at(u, uniform(random)));
        const auto bin = [](double x) {
            EXPECT_TRUE(x > -1e-9 && x < 1.0 + 1e-9) << x;
            return static_cast<std::size_t>(std::clamp(x * bins, 0.0, bins - 1.0));
        };
        ++counts[bin(where.x) * bins + bin(where.y)];
    }
    constexpr double expected = static_cast<double>(samples) / (bins * bins);
    double sum = 0;
    for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

/// Azimuth about an axis, as a fraction of a turn.
double turn(const glm::dvec3& v, const glm::dmat3& frame) {
    return 0.5 + std::atan2(glm::dot(v, frame[1]), glm::dot(v, frame[0])) / (2 * pi);
}

/// A cap, uniform in solid angle: height and azimuth.
template <typename Sample>
glm::dvec2 on_cap(const Sample& sample, const glm::dvec3& axis, double angular_radius) {
    const double height = 1.0 - std::cos(angular_radius);
    return {(1.0 - glm::dot(sample.direction, axis)) / height, turn(sample.direction, frame_around(axis))};
}

TEST(SampleLight, CoversTheSunEvenly) {
    FlatLight sun;
    sun.kind = LightKind::sun;
    sun.direction = {1, 2, -3};
    sun.sun_angle = 0.6;
    const glm::dvec3 axis = -unit(sun.direction);
    EXPECT_LT(
        chi_square(PreparedLight(sun), {}, {0, 0, 1}, [&](const auto& s) { return on_cap(s, axis, 0.3); }),
        chi_square_limit);
}

TEST(SampleLight, CoversABallEvenlyFromOutsideAndTheHemisphereFromWithin) {
    FlatLight ball;
    ball.position = {0, 0, 2};
    ball.radius = 1.5;
    ball.soft_falloff = false;
    const glm::dvec3 normal(0, 1, 0);
    const glm::dvec3 up(0, 0, 1);
    EXPECT_LT(chi_square(PreparedLight(ball), {}, normal,
                         [&](const auto& s) { return on_cap(s, up, std::asin(0.75)); }),
              chi_square_limit);
    EXPECT_LT(chi_square(PreparedLight(ball), {0, 0, 1}, normal,
                         [&](const auto& s) { return on_cap(s, normal, 0.5 * pi); }),
              chi_square_limit);
    // The disk that faces the point, of the cap that it is seen under.
    ball.soft_falloff = true;
    EXPECT_LT(chi_square(PreparedLight(ball), {}, normal,
                         [&](const auto& s) { return on_cap(s, up, std::atan(0.75)); }),
              chi_square_limit);
}

TEST(SampleLight, CoversFlatLightsEvenlyInArea) {
    FlatLight area;
    area.kind = LightKind::area;
    area.position = {1, 2, 3};
    area.direction = {0, 1, -2};
    area.tangent = {1, 0.5, 0};
    area.size_x = 3;
    area.size_y = 0.5;
    const glm::dvec3 point(0, 3, -1);
    const glm::dmat3 frame = frame_around(area.direction, area.tangent);
    const auto local = [&](const LightSample& s) {
        const glm::dvec3 offset = point + s.distance * s.direction - area.position;
        return glm::dvec2(glm::dot(offset, frame[0]) / 1.5, glm::dot(offset, frame[1]) / 0.25);
    };
    const auto rectangle = [&](const LightSample& s) { return 0.5 + 0.5 * local(s); };
    EXPECT_LT(chi_square(PreparedLight(area), point, {0, 0, 1}, rectangle), chi_square_limit);
    area.area_shape = AreaShape::ellipse;
    const auto ellipse = [&](const LightSample& s) {
        const glm::dvec2 p = local(s);
        return glm::dvec2(glm::dot(p, p), 0.5 + std::atan2(p.y, p.x) / (2 * pi));
    };
    EXPECT_LT(chi_square(PreparedLight(area), point, {0, 0, 1}, ellipse), chi_square_limit);
    // The test sees a sampler that is not even: the ellipse's samples, taken for a rectangle's.
    EXPECT_GT(chi_square(PreparedLight(area), point, {0, 0, 1}, rectangle), 100 * chi_square_limit);
}

}  // namespace
}  // namespace skinglow
