#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "files/mesh_file.h"
#include "files/polygon_cut.h"
#include "mesh_samples.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

using Outline = std::vector<glm::dvec2>;

double outline_area(const Outline& outline) {
    double area = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2& a = outline[i];
        const glm::dvec2& b = outline[(i + 1) % outline.size()];
        area += (a.x * b.y - b.x * a.y) / 2.0;
    }
    return area;
}

/// Cuts the outline as a polygon of a tilted plane and checks that the triangles fill it, each wound as it
/// is.
void expect_filled(const Outline& outline, const glm::dvec3& offset = glm::dvec3(0.0)) {
    const glm::dvec3 u(0.6, 0.0, 0.8);
    const glm::dvec3 v(0.0, 1.0, 0.0);
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> corners;
    for (const glm::dvec2& point : outline) {
        corners.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(offset + point.x * u + point.y * v);
    }
    std::vector<glm::uvec3> triangles;
    ASSERT_TRUE(PolygonCutter().cut(corners, positions, triangles));
    ASSERT_EQ(triangles.size(), outline.size() - 2);
    const glm::dvec3 normal = glm::cross(u, v);
    double area = 0.0;
    double smallest = 0.0;
    for (const glm::uvec3& t : triangles) {
        const double signed_area =
            glm::dot(normal, glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x])) /
            2.0;
        area += std::abs(signed_area);
        smallest = std::min(smallest, signed_area);
    }
    const double whole = outline_area(outline);
    EXPECT_NEAR(area, whole, 1e-8 * std::abs(whole)) << outline.size() << " corners";
    EXPECT_GE(smallest, -1e-9 * std::abs(whole));
}

Outline star(std::size_t corners, double inner) {
    Outline outline;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        outline.push_back((i % 2 == 0 ? 1.0 : inner) * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return outline;
}

/// A band that winds up around its center.
Outline spiral(std::size_t corners) {
    Outline outline;
    const std::size_t half = corners / 2;
    const double turns = 12.0 * std::numbers::pi;
    const auto point = [&](double t, double radius) {
        return (1.0 + t + radius) * glm::dvec2(std::cos(turns * t), std::sin(turns * t));
    };
    for (std::size_t i = 0; i < half; ++i) outline.push_back(point(double(i) / double(half - 1), 0.05));
    for (std::size_t i = half; i-- > 0;) outline.push_back(point(double(i) / double(half - 1), 0.0));
    return outline;
}

Outline comb(std::size_t teeth) {
    Outline outline{{0.0, -1.0}, {static_cast<double>(teeth), -1.0}};
    for (std::size_t i = teeth; i-- > 0;) {
        const auto x = static_cast<double>(i);
        outline.insert(outline.end(), {{x + 1.0, 0.0}, {x + 0.9, 50.0}, {x + 0.1, 50.0}, {x, 0.0}});
    }
    return outline;
}

TEST(Polygons, ConcaveOnesAreFilledOnce) {
    expect_filled({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});  // an L
    expect_filled({{0, 0}, {2, 1}, {0, 2}, {1, 1}});                  // an arrowhead, from each corner
    expect_filled({{2, 1}, {0, 2}, {1, 1}, {0, 0}});
    expect_filled({{0, 2}, {1, 1}, {0, 0}, {2, 1}});
    expect_filled(
        {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});  // with a hole
    expect_filled(
        {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});  // corners on straight sides
    expect_filled({{0, 0}, {0, 0}, {2, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {0, 2}});  // corners twice
    expect_filled(star(10, 0.2), {5e6, -5e6, 5e6});
    expect_filled(comb(7));
}

TEST(Polygons, RandomOutlinesAreFilledOnce) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> radius(0.1, 1.0);
    for (int i = 0; i < 400; ++i) {
        const auto corners = static_cast<std::size_t>(4 + i % 60);
        Outline outline = star(corners, 1.0);
        for (glm::dvec2& point : outline) point *= radius(random);
        SCOPED_TRACE(i);
        expect_filled(outline);
    }
}

/// Three times as many corners take less than seven times as long; quadratic would be nine.
// In quadratic time these would take hours, and the test runner ends a test long before.
TEST(Polygons, OfHundredsOfThousandsOfCornersAreFilled) {
    expect_filled(star(900'000, 0.999));
    expect_filled(star(450'000, 1.0));
    expect_filled(spiral(450'000));
    expect_filled(comb(112'000));
}

}  // namespace
}  // namespace skinglow::test
