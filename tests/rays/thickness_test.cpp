#include <gtest/gtest.h>
#include <skinglow/thickness.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mesh_shapes.h"

namespace skinglow {
namespace {

using shapes::Mesh;

std::vector<double> measure(const Mesh& mesh, const ThicknessOptions& options = {}) {
    return thickness(mesh.view(), options);
}

/// How far a vertex of a box is from the edges of its face: the second smallest distance to a wall.
double distance_from_edges(const glm::dvec3& vertex, const glm::dvec3& size) {
    std::array<double, 3> d{};
    for (int k = 0; k < 3; ++k) d[static_cast<std::size_t>(k)] = std::min(vertex[k], size[k] - vertex[k]);
    std::sort(d.begin(), d.end());
    return d[1];
}

std::string refusal(const Mesh& mesh, const ThicknessOptions& options = {}) {
    try {
        measure(mesh, options);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Thickness, OfASphereIsItsDiameter) {
    const Mesh mesh = shapes::sphere(10.0, 5);
    // The facets lie inside the sphere, by up to (edge / 2)^2 / (2 radius): 0.009 here with an edge of 0.86
    // at most.
    for (const double d : measure(mesh)) EXPECT_NEAR(d, 20.0, 0.02);
}

TEST(Thickness, OfASphereConvergesWithTheSquareOfTheEdge) {
    const auto worst = [](int levels) {
        double error = 0;
        for (const double d : measure(shapes::sphere(1.0, levels)))
            error = std::max(error, std::abs(d - 2.0));
        return error;
    };
    const double coarse = worst(3);
    const double fine = worst(5);
    EXPECT_LT(fine, coarse / 10.0);  // 16 where it is exactly of second order
}

TEST(Thickness, OfAShellIsItsWallSeenFromBothSides) {
    for (const double wall : {0.5, 1.0}) {
        const Mesh mesh = shapes::shell(10.0, wall, 5);
        const auto values = measure(mesh);
        const std::size_t half = values.size() / 2;
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_NEAR(values[i], wall, 0.015 * wall) << (i < half ? "outer" : "inner") << " vertex " << i;
        }
    }
}

TEST(Thickness, OfABoxIsExactAwayFromItsEdges) {
    for (const glm::dvec3& size : {glm::dvec3(10, 10, 10), glm::dvec3(10, 20, 30), glm::dvec3(1, 30, 30)}) {
        const Mesh mesh = shapes::box(size, 12);
        const auto values = measure(mesh);
        int checked = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::dvec3& v = mesh.vertices[i];
            int axis = 0;
            while (axis < 3 && v[axis] != 0 && v[axis] != size[axis]) ++axis;
            // Half the cone's opening at the far side: nearer the edge, rays meet the wall beside it.
            if (distance_from_edges(v, size) < size[axis] / 2) continue;
            ASSERT_NEAR(values[i], size[axis], 1e-9 * size[axis]) << "vertex " << i;
            ++checked;
        }
        EXPECT_GT(checked, 0);
    }
}

TEST(Thickness, OfAThinPlateIsExactAlsoNearItsEdges) {
    for (const double d : {2.0, 0.1, 0.001}) {
        const glm::dvec3 size(40, 40, d);
        const Mesh mesh = shapes::box(size, 16);
        const auto values = measure(mesh);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::dvec3& v = mesh.vertices[i];
            const bool on_rim = v.x == 0 || v.x == 40 || v.y == 0 || v.y == 40;
            if (on_rim) {
                // A ball against the rim cannot be thicker than the plate; a sharp edge may take it down.
                ASSERT_LE(values[i], 1.3 * d) << "vertex " << i;
                ASSERT_GT(values[i], 0) << "vertex " << i;
            } else {
                ASSERT_NEAR(values[i], d, 1e-6 * d) << "vertex " << i;
            }
        }
    }
}

TEST(Thickness, StaysBelowTheBoundOfASharpCorner) {
    for (const double d : measure(shapes::box({1, 1, 1}, 4))) {
        EXPECT_LE(d, 2.0 / (1.0 + std::sqrt(1.0 / 3.0)) + 1e-9);  // the corner's ball: 2 h / (1 + cos b)
        EXPECT_GT(d, 0.3);
    }
}

/// A ray through an edge may leave by either of its triangles, as rounding falls: one or two rays of all.
constexpr double either_triangle = 1e-4;

TEST(Thickness, ScalesWithTheMeshAndTheUnit) {
    const Mesh mesh = shapes::shell(1.0, 0.2, 3);
    const auto expected = measure(mesh);
    for (const double scale : {1e-300, 1e-6, 1e6, 1e300}) {
        Mesh scaled = mesh;
        for (glm::dvec3& v : scaled.vertices) v *= scale;
        const auto values = measure(scaled);
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_NEAR(values[i] / scale, expected[i], either_triangle);
    }
    const auto in_mm = measure(mesh, {.unit_mm = 50.35});
    for (std::size_t i = 0; i < in_mm.size(); ++i) ASSERT_DOUBLE_EQ(in_mm[i], 50.35 * expected[i]);
}

TEST(Thickness, DoesNotDependOnWhereTheMeshIs) {
    const Mesh mesh = shapes::shell(1.0, 0.2, 3);
    const auto expected = measure(mesh);
    for (const double offset : {1e3, 1e6}) {
        Mesh moved = mesh;
        for (glm::dvec3& v : moved.vertices) v += glm::dvec3(offset, -offset, 3 * offset);
        const auto values = measure(moved);
        for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i], expected[i], either_triangle);
    }
}

TEST(Thickness, IsTheSameOnAnyNumberOfThreads) {
    const Mesh mesh = shapes::shell(1.0, 0.3, 4);
    const auto expected = measure(mesh, {.threads = 1});
    for (const int threads : {0, 2, 3, 8}) EXPECT_EQ(measure(mesh, {.threads = threads}), expected);
}

TEST(Thickness, DoesNotMindAMeshTurnedInsideOut) {
    Mesh mesh = shapes::shell(1.0, 0.2, 3);
    const auto expected = measure(mesh);
    mesh.flip();
    const auto values = measure(mesh);
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i], expected[i], 1e-9);
}

TEST(Thickness, OfAnOpenPlaneIsTheBoxesDiagonal) {
    const Mesh plane{{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (const double d : measure(plane, {.unit_mm = 10})) EXPECT_DOUBLE_EQ(d, 50.0);
}

TEST(Thickness, GivesVerticesAtOnePositionOneValue) {
    const glm::dvec3 size(3, 4, 5);
    const Mesh mesh = shapes::box(size, 4);  // edge vertices are there two or three times
    const auto values = measure(mesh);
    int pairs = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t j = i + 1; j < values.size(); ++j) {
            if (mesh.vertices[i] != mesh.vertices[j]) continue;
            EXPECT_EQ(values[i], values[j]);
            ++pairs;
        }
    }
    EXPECT_GT(pairs, 12 * 5 - 1);
}

TEST(Thickness, IgnoresTrianglesWithoutAreaDuplicatesAndStrayVertices) {
    Mesh mesh = shapes::sphere(1.0, 3);
    const auto expected = measure(mesh);
    const std::size_t count = mesh.vertices.size();
    mesh.triangles.insert(mesh.triangles.begin(), {{0, 0, 0}, {1, 1, 2}});
    mesh.vertices.emplace_back(mesh.vertices[0]);                             // a twin
    mesh.vertices.emplace_back(0.5 * (mesh.vertices[0] + mesh.vertices[2]));  // of a triangle without area
    mesh.vertices.emplace_back(1e9, 0, 0);                                    // of nothing, far away
    const auto last = static_cast<std::uint32_t>(count);
    mesh.triangles.push_back({0, last + 1, 2});
    const auto values = measure(mesh);
    for (std::size_t i = 0; i < count; ++i) ASSERT_NEAR(values[i], expected[i], 1e-9);
    EXPECT_EQ(values[count], values[0]);
    EXPECT_DOUBLE_EQ(values[count + 1], 2.0 * std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(values[count + 2], 2.0 * std::sqrt(3.0));
}

TEST(Thickness, PassesBodiesWithinTheBody) {
    Mesh head = shapes::sphere(10.0, 4);
    head.append(shapes::sphere(3.0, 3));  // wound outwards: an eyeball, not a cavity
    const auto values = measure(head);
    const std::size_t outer = shapes::sphere(10.0, 4).vertices.size();
    for (std::size_t i = 0; i < outer; ++i) ASSERT_NEAR(values[i], 20.0, 0.1);
}

TEST(Thickness, PassesDarkCavitiesWhenAsked) {
    const Mesh mesh = shapes::shell(10.0, 1.0, 5);
    const auto values = measure(mesh, {.min_sky_visibility = 0.05});
    const std::size_t half = values.size() / 2;
    for (std::size_t i = 0; i < half; ++i) ASSERT_NEAR(values[i], 20.0, 0.1) << "outer vertex " << i;
    for (std::size_t i = half; i < values.size(); ++i)
        ASSERT_NEAR(values[i], 1.0, 0.02) << "inner vertex " << i;
    // A convex body is lit everywhere.
    const Mesh ball = shapes::sphere(1.0, 4);
    EXPECT_EQ(measure(ball, {.min_sky_visibility = 1.0}), measure(ball));
}

TEST(Thickness, OfPointsAtOnePlaceIsZero) {
    const Mesh mesh{{{7, 7, 7}, {7, 7, 7}, {7, 7, 7}}, {{0, 1, 2}}};
    EXPECT_EQ(measure(mesh), std::vector<double>(3, 0.0));
}

TEST(Thickness, OfNothingIsNothing) {
    EXPECT_TRUE(measure({}).empty());
}

TEST(Thickness, IsFiniteAndBoundedOnTangledMeshes) {
    Mesh tangle = shapes::box({1, 1, 1}, 2);
    std::uint32_t state = 1;  // a fixed sequence: a failure must come again
    const auto next = [&] { return (state = state * 1664525U + 1013904223U) >> 8U; };
    for (glm::dvec3& v : tangle.vertices) v += glm::dvec3(next() % 97, next() % 89, next() % 83) / 50.0;
    for (int i = 0; i < 40; ++i) {
        const auto n = static_cast<std::uint32_t>(tangle.vertices.size());
        tangle.triangles.push_back({next() % n, next() % n, next() % n});
    }
    for (const double cone : {0.0, 0.5, 1.5}) {
        for (const double d : measure(tangle, {.cone_half_angle = cone})) {
            EXPECT_TRUE(std::isfinite(d));
            EXPECT_GE(d, 0.0);
            EXPECT_LE(d, std::sqrt(3.0) * (1.0 + 96.0 / 50.0));
        }
    }
}

TEST(Thickness, ReportsProgressAndStopsWhenAsked) {
    const Mesh mesh = shapes::sphere(1.0, 5);
    std::vector<double> told;
    thickness(mesh.view(), {.min_sky_visibility = 0.1, .threads = 2}, [&](double done) {
        told.push_back(done);
        return true;
    });
    ASSERT_GT(told.size(), 3U);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GE(told.front(), 0.0);
    EXPECT_EQ(told.back(), 1.0);

    int calls = 0;
    EXPECT_THROW(thickness(mesh.view(), {.threads = 2}, [&](double) { return ++calls < 3; }),
                 ThicknessCancelled);
    EXPECT_EQ(calls, 3);
}

TEST(Thickness, RefusesWhatIsWrongByName) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Mesh ball = shapes::sphere(1.0, 1);
    Mesh bad = ball;
    bad.vertices[7].y = nan;
    EXPECT_NE(refusal(bad).find("vertices[7]"), std::string::npos) << refusal(bad);
    bad = ball;
    bad.vertices[3].x = std::numeric_limits<double>::infinity();
    EXPECT_NE(refusal(bad).find("vertices[3]"), std::string::npos) << refusal(bad);
    bad = ball;
    bad.triangles[5].z = 18;
    EXPECT_NE(refusal(bad).find("triangles[5]"), std::string::npos) << refusal(bad);
    EXPECT_NE(refusal(bad).find("below 18"), std::string::npos) << refusal(bad);
    bad = ball;
    bad.triangles.clear();
    EXPECT_NE(refusal(bad).find("triangles"), std::string::npos) << refusal(bad);
    bad = ball;
    bad.vertices[0] = {1.7e308, 1.7e308, 1.7e308};
    bad.vertices[1] = {-1.7e308, -1.7e308, -1.7e308};
    EXPECT_NE(refusal(bad).find("vertices"), std::string::npos) << refusal(bad);

    for (const double unit : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(refusal(ball, {.unit_mm = unit}).find("unit_mm"), 0U);
    }
    EXPECT_EQ(refusal(shapes::sphere(1e200, 1), {.unit_mm = 1e200}).find("unit_mm"), 0U);
    for (const int rays : {0, -1, 65537}) EXPECT_EQ(refusal(ball, {.rays = rays}).find("rays"), 0U);
    for (const double angle : {-0.1, 1.6, nan}) {
        EXPECT_EQ(refusal(ball, {.cone_half_angle = angle}).find("cone_half_angle"), 0U);
    }
    for (const double fraction : {-0.1, 1.1, nan}) {
        EXPECT_EQ(refusal(ball, {.min_sky_visibility = fraction}).find("min_sky_visibility"), 0U);
    }
    EXPECT_EQ(refusal(ball, {.threads = -1}).find("threads"), 0U);
}

}  // namespace
}  // namespace skinglow
