#include <gtest/gtest.h>
#include <skinglow/occlusion.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <string>

#include "mesh_shapes.h"
#include "random_lights.h"
#include "rig/irradiance.h"

namespace skinglow {
namespace {

using shapes::Mesh;
constexpr double pi = std::numbers::pi;
const glm::dvec3 up(0, 0, 1);

Occluders occluders_of(const std::vector<Mesh>& meshes,
                       const std::optional<glm::dvec3>& origin = std::nullopt) {
    std::vector<MeshView> views;
    for (const Mesh& mesh : meshes) {
        views.emplace_back(mesh.vertices, mesh.triangles, "meshes[" + std::to_string(views.size()) + "] ");
    }
    return Occluders(views, origin);
}

/// An upright-or-flat rectangle: corner, and two edges.
Mesh sheet(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b) {
    return {{corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Covers x > `from_x` at that height.
Mesh half_plane(double from_x, double height) {
    return sheet({from_x, -1000, height}, {1000, 0, 0}, {0, 2000, 0});
}

Mesh moved(Mesh mesh, const glm::dvec3& by, double scale = 1.0) {
    for (glm::dvec3& v : mesh.vertices) v = v * scale + by;
    return mesh;
}

Light point_lamp(const glm::dvec3& position) {
    Light light;
    light.position = position;
    return light;
}

Light area_lamp(AreaShape shape, double size_x, double size_y, double height) {
    Light light;
    light.kind = LightKind::area;
    light.area_shape = shape;
    light.size_x = size_x;
    light.size_y = size_y;
    light.position = {0, 0, height};
    return light;
}

double share(const Occluders& occluders, const Light& light, const glm::dvec3& point = glm::dvec3(0),
             const glm::dvec3& normal = up, const VisibilityOptions& options = {}) {
    const VisibleFraction found =
        visible_fraction(occluders, {&light, 1}, {&point, 1}, {&normal, 1}, options);
    EXPECT_DOUBLE_EQ(found.mean[0], found.at_points[0]);
    return found.mean[0];
}

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Visibility, HalfPlaneLeavesHalfOfADisk) {
    const Occluders occluders = occluders_of({half_plane(0, 1)});
    const Light disk = area_lamp(AreaShape::ellipse, 1, 1, 2);
    EXPECT_NEAR(share(occluders, disk, {}, up, {.samples = 4096}), 0.5, 5e-4);
    EXPECT_NEAR(share(occluders, disk), 0.5, 0.07);  // the default, from one place
    Light ball = point_lamp({0, 0, 2});
    ball.radius = 0.5;
    EXPECT_NEAR(share(occluders, ball, {}, up, {.samples = 4096}), 0.5, 5e-4);
    ball.soft_falloff = false;
    EXPECT_NEAR(share(occluders, ball, {}, up, {.samples = 4096}), 0.5, 5e-4);
    Light sun;
    sun.kind = LightKind::sun;
    sun.sun_angle = 0.3;
    EXPECT_NEAR(share(occluders, sun, {}, up, {.samples = 4096}), 0.5, 5e-4);
}

TEST(Visibility, HalfARectangleIsAsBrightAsThatHalfAlone) {
    // What is left of a near, oblique lamp, against the closed form of a lamp half as wide.
    for (const AreaShape shape : {AreaShape::rectangle, AreaShape::ellipse}) {
        for (const double spread : {pi, 1.6}) {
            Light whole = area_lamp(shape, 2, 1, 1);
            whole.spread = spread;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.6, 0.3, 1));
            const Occluders left = occluders_of({half_plane(0, 0.5)});
            const Occluders right = occluders_of({sheet({-1000, -1000, 0.5}, {1000, 0, 0}, {0, 2000, 0})});
            const double a = share(left, whole, {}, normal, {.samples = 4096});
            const double b = share(right, whole, {}, normal, {.samples = 4096});
            EXPECT_NEAR(a + b, 1.0, 1e-3);  // both stop a way along their common edge
            if (shape == AreaShape::ellipse || spread < pi) continue;
            Light half = whole;
            half.size_x = 1;
            half.position.x = -0.5;
            half.power = 0.5;
            const double expected = irradiance(half, {}, normal).r / irradiance(whole, {}, normal).r;
            EXPECT_GT(expected, 0.6);
            EXPECT_NEAR(a, expected, 1e-3);
        }
    }
}

TEST(Visibility, BallEclipsesASun) {
    // Seen on its axis a round patch brings pi L sin^2 of its radius, so that is what a smaller one takes.
    Light sun;
    sun.kind = LightKind::sun;
    sun.sun_angle = 0.6;
    const double sine = 0.2;
    const Occluders occluders = occluders_of({moved(shapes::sphere(2 * sine, 6), {0, 0, 2})});
    const double expected = 1.0 - sine * sine / std::pow(std::sin(0.3), 2);
    EXPECT_NEAR(share(occluders, sun, {}, up, {.samples = 4096}), expected, 2e-3);
}

TEST(Visibility, BallBeforeAPointLampHidesItAndBesideItDoesNot) {
    const Light lamp = point_lamp({0, 0, 4});
    EXPECT_EQ(share(occluders_of({moved(shapes::sphere(0.5, 3), {0, 0, 2})}), lamp), 0.0);
    EXPECT_EQ(share(occluders_of({moved(shapes::sphere(0.5, 3), {0.6, 0, 2})}), lamp), 1.0);
    EXPECT_EQ(share(occluders_of({}), lamp), 1.0);
}

TEST(Visibility, WhatStandsBehindTheLampOrTouchesItDoesNotCount) {
    const Occluders ceiling = occluders_of({sheet({-50, -50, 3}, {100, 0, 0}, {0, 100, 0})});
    for (const double height : {2.0, 2.99, 3.0}) {
        EXPECT_EQ(share(ceiling, point_lamp({0.3, 0.2, height})), 1.0) << height;
        EXPECT_EQ(share(ceiling, area_lamp(AreaShape::rectangle, 2, 1, height)), 1.0) << height;
    }
    EXPECT_EQ(share(ceiling, point_lamp({0.3, 0.2, 3.01})), 0.0);
    // Nor does what the place lies on.
    const Occluders floor = occluders_of({sheet({-50, -50, 0}, {100, 0, 0}, {0, 100, 0})});
    EXPECT_EQ(share(floor, point_lamp({0.3, 0.2, 2}), {5, 7, 0}), 1.0);
}

TEST(Visibility, BallLampEndsAtItsSurface) {
    Light ball = point_lamp({0, 0, 2});
    ball.radius = 0.5;
    ball.soft_falloff = false;
    // A sheet within the ball is behind its near side, one before it is not.
    EXPECT_EQ(share(occluders_of({sheet({-5, -5, 2.2}, {10, 0, 0}, {0, 10, 0})}), ball), 1.0);
    EXPECT_EQ(share(occluders_of({sheet({-5, -5, 1.4}, {10, 0, 0}, {0, 10, 0})}), ball), 0.0);
    // From within it light comes from everywhere; what is farther than the ball's surface does not stop it.
    EXPECT_EQ(share(occluders_of({shapes::sphere(5, 3)}), ball, {0, 0, 2.1}), 1.0);
    EXPECT_EQ(share(occluders_of({moved(shapes::sphere(0.05, 3), {0, 0, 2.1})}), ball, {0, 0, 2.1}), 0.0);
}

TEST(Visibility, MeshesLeftOutDoNotCount) {
    const std::vector<Mesh> meshes{moved(shapes::sphere(0.5, 3), {0, 0, 1}), half_plane(-1, 2),
                                   moved(shapes::sphere(0.5, 3), {0, 0, 3})};
    const Occluders occluders = occluders_of(meshes);
    EXPECT_EQ(occluders.meshes(), 3U);
    const Light lamp = point_lamp({0, 0, 4});
    EXPECT_EQ(share(occluders, lamp), 0.0);
    EXPECT_EQ(share(occluders, lamp, {}, up, {.excluded = {0, 1}}), 0.0);
    EXPECT_EQ(share(occluders, lamp, {}, up, {.excluded = {1, 2}}), 0.0);
    EXPECT_EQ(share(occluders, lamp, {}, up, {.excluded = {2, 0, 1}}), 1.0);
    EXPECT_NE(
        refusal([&] { share(occluders, lamp, {}, up, {.excluded = {3}}); }).find("is 3; allowed: below"),
        std::string::npos);
}

TEST(Visibility, MeanCountsPlacesByWhatTheLampWouldBring) {
    const Occluders wall = occluders_of({half_plane(1, 1)});
    const Light lamp = point_lamp({0, 0, 2});
    // Lit; in the wall's shadow; facing away, which the wall cannot help.
    const std::vector<glm::dvec3> points{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}};
    const std::vector<glm::dvec3> normals{{0, 0, 5}, {-1, 0, 1}, {0, 0, -1}};
    const VisibleFraction found = visible_fraction(wall, {&lamp, 1}, points, normals);
    EXPECT_EQ(found.at_points, (std::vector<double>{1, 0, 1}));
    const double lit = irradiance(lamp, points[0], normals[0]).r;
    const double dark = irradiance(lamp, points[1], normals[1]).r;
    EXPECT_NEAR(found.mean[0], lit / (lit + dark), 1e-12);
    const std::vector<glm::dvec3> away(3, -up);
    EXPECT_EQ(visible_fraction(wall, {&lamp, 1}, points, away).mean[0], 1.0);
    EXPECT_EQ(visible_fraction(wall, {&lamp, 1}, points, std::vector<glm::dvec3>(3, glm::dvec3(0))).mean[0],
              1.0);
}

TEST(Visibility, MeanOverPlacesIsFarBetterThanOne) {
    // The shadow's edge crosses a row of places; the mean of their shares is the mean of a closed form.
    Light disk = area_lamp(AreaShape::rectangle, 1, 1, 2);
    const Occluders wall = occluders_of({half_plane(0, 1)});
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 256; ++i) points.emplace_back(-0.5 + (i + 0.5) / 256, 0.0, 0.0);
    const std::vector<glm::dvec3> normals(points.size(), up);
    const VisibleFraction found = visible_fraction(wall, {&disk, 1}, points, normals);
    EXPECT_NEAR(found.mean[0], 0.5, 2e-3);  // by symmetry
}

/// Whether a segment meets a triangle, in double precision (T. Moeller and B. Trumbore, "Fast, minimum
/// storage ray/triangle intersection", 1997); `margin` is how near it is to deciding otherwise.
bool meets(const Mesh& mesh, const glm::uvec3& t, const glm::dvec3& from, const glm::dvec3& to,
           double& margin) {
    const glm::dvec3 a = mesh.vertices[t.x];
    const glm::dvec3 e1 = mesh.vertices[t.y] - a;
    const glm::dvec3 e2 = mesh.vertices[t.z] - a;
    const glm::dvec3 d = to - from;
    const glm::dvec3 p = glm::cross(d, e2);
    const double det = glm::dot(e1, p);
    const glm::dvec3 s = from - a;
    const double u = glm::dot(s, p) / det;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(d, q) / det;
    const double w = glm::dot(e2, q) / det;
    const double inside = std::min({u, v, 1.0 - u - v, w, 1.0 - w});
    margin = std::min(margin, std::abs(inside));
    return inside > 0.0;
}

TEST(Visibility, AgreesWithBruteForceInDoublePrecision) {
    RandomScene random(11);
    int compared = 0;
    int hidden = 0;
    for (int round = 0; round < 60; ++round) {
        const double scale = random.decades(1e-3, 1e6);
        const glm::dvec3 offset = random.in_box(glm::dvec3(-1e4), glm::dvec3(1e4)) * scale;
        Mesh soup;
        for (std::uint32_t i = 0; i < 30; ++i) {
            for (int k = 0; k < 3; ++k)
                soup.vertices.push_back(offset + random.in_box(glm::dvec3(-1), glm::dvec3(1)) * scale);
            soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        const Occluders occluders = occluders_of({soup});
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 from = offset + random.in_box(glm::dvec3(-2), glm::dvec3(2)) * scale;
            const glm::dvec3 to = offset + random.in_box(glm::dvec3(-2), glm::dvec3(2)) * scale;
            double margin = 1;
            bool hit = false;
            for (const glm::uvec3& t : soup.triangles) hit = meets(soup, t, from, to, margin) || hit;
            if (margin < 1e-3) continue;
            ++compared;
            hidden += hit ? 1 : 0;
            EXPECT_EQ(share(occluders, point_lamp(to), from, to - from), hit ? 0.0 : 1.0) << round;
        }
    }
    EXPECT_GT(compared, 3000);
    EXPECT_GT(hidden, 500);
    EXPECT_LT(hidden, compared - 500);
}

TEST(Visibility, OfAnySceneIsAShareAndTheSameOnAnyNumberOfThreads) {
    RandomScene random(5);
    std::vector<Mesh> meshes;
    for (int i = 0; i < 6; ++i)
        meshes.push_back(
            moved(shapes::sphere(random.decades(0.1, 3), 2), random.unit_vector() * random.decades(0.2, 30)));
    const Occluders occluders = occluders_of(meshes);
    const std::vector<Light> lights = random.lights(60);
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    for (int i = 0; i < 40; ++i) {
        points.push_back(random.in_box(glm::dvec3(-2), glm::dvec3(2)));
        normals.push_back(random.unit_vector() * random.decades(1e-3, 1e3));
    }
    const VisibleFraction one = visible_fraction(occluders, lights, points, normals, {.threads = 1});
    const VisibleFraction many = visible_fraction(occluders, lights, points, normals, {.threads = 4});
    EXPECT_EQ(one.at_points, many.at_points);
    EXPECT_EQ(one.mean, many.mean);
    int between = 0;
    for (const double value : one.at_points) {
        EXPECT_TRUE(value >= 0.0 && value <= 1.0) << value;
        between += value > 0.0 && value < 1.0 ? 1 : 0;
    }
    EXPECT_GT(between, 100);
    // More in the way never lets more through.
    std::vector<Mesh> more = meshes;
    more.push_back(half_plane(0.5, 0.5));
    const VisibleFraction less = visible_fraction(occluders_of(more), lights, points, normals);
    for (std::size_t i = 0; i < one.at_points.size(); ++i)
        EXPECT_LE(less.at_points[i], one.at_points[i] + 1e-12);
}

TEST(Visibility, HugeScenesKeepWhatIsNearThePlaceAsked) {
    // A head and a wall of some centimeters beside a ground of a thousand kilometers.
    for (const glm::dvec3& where : {glm::dvec3(0), glm::dvec3(3e5, -2e5, 0)}) {
        const std::vector<Mesh> meshes{sheet({-1e6, -1e6, -2}, {2e6, 0, 0}, {0, 2e6, 0}),
                                       moved(shapes::sphere(0.02, 3), where + glm::dvec3(0, 0, 0.1))};
        const Occluders occluders = occluders_of(meshes, where);
        EXPECT_EQ(share(occluders, point_lamp(where + glm::dvec3(0, 0, 1)), where), 0.0);
        EXPECT_EQ(share(occluders, point_lamp(where + glm::dvec3(0, 0, 1)), where + glm::dvec3(0.03, 0, 0)),
                  1.0);
        EXPECT_EQ(share(occluders, point_lamp(where + glm::dvec3(0, 0, 1e6)), where), 0.0);
        EXPECT_EQ(share(occluders, point_lamp(where + glm::dvec3(0, 0, -3)), where, -up), 0.0);
    }
}

TEST(Visibility, ExtremesGiveAShare) {
    const Mesh ball = shapes::sphere(1, 3);
    const Occluders occluders = occluders_of({ball});
    EXPECT_EQ(share(occluders, point_lamp({0.2, 0, 0}), {0, 0, 3}, -up), 0.0);    // a lamp inside the mesh
    EXPECT_EQ(share(occluders, point_lamp({0.2, 0, 0}), {0, 0, 0.5}, -up), 1.0);  // and the place, too
    EXPECT_EQ(share(occluders, point_lamp({3, 0, 0}), {3, 0, 0}), 1.0);           // at distance 0
    EXPECT_EQ(share(occluders, point_lamp({0, 0, 1e100}), {0, 0, -3}), 0.0);
    EXPECT_EQ(share(occluders, point_lamp({0, 0, 1e100}), {3, 0, -3}), 1.0);
    EXPECT_EQ(share(occluders, point_lamp({0, 0, 2}), {0, 0, -1e6}), 0.0);
    Light wide = area_lamp(AreaShape::ellipse, 1e9, 1e9, 2);
    const double seen = share(occluders, wide, {0, 0, -2}, up, {.samples = 256});
    EXPECT_TRUE(seen > 0.9 && seen <= 1.0) << seen;
    for (const double size : {1e-30, 1e-150, 1e150, 1e300}) {
        const Occluders scaled = occluders_of({moved(ball, {}, size)});
        Light sun;
        sun.kind = LightKind::sun;
        EXPECT_EQ(share(scaled, sun, {0, 0, -2 * size}), 0.0) << size;
        EXPECT_EQ(share(scaled, sun, {2 * size, 0, -2 * size}), 1.0) << size;
    }
    Light far_up = point_lamp({0, 0, 1e308});
    for (const double x : {-1e308, 1e308}) {
        const double value = share(occluders, far_up, {x, 0, 0});
        EXPECT_TRUE(value >= 0.0 && value <= 1.0);
    }
}

TEST(Visibility, TrianglesWithoutAreaStopNothing) {
    const Mesh thin{{{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}, {1e300, 7, 1}}, {{0, 1, 2}, {0, 0, 1}, {2, 2, 2}}};
    const Occluders occluders = occluders_of({thin, {}, {{{0, 0, 1}}, {}}});
    EXPECT_EQ(occluders.triangles(), 0U);
    EXPECT_EQ(share(occluders, point_lamp({0, 0, 2})), 1.0);
    // A vertex that no triangle uses costs the others nothing.
    Mesh ball = moved(shapes::sphere(0.5, 3), {0, 0, 1});
    ball.vertices.emplace_back(1e300, 0, 0);
    EXPECT_EQ(share(occluders_of({ball}), point_lamp({0, 0, 2})), 0.0);
}

TEST(Visibility, LampsThatGiveNothingAreNotTraced) {
    const Occluders wall = occluders_of({half_plane(-1, 1)});
    Light off = point_lamp({0, 0, 2});
    off.visible = false;
    Light dark = off;
    dark.visible = true;
    dark.power = 0;
    Light negative = dark;
    negative.power = -5;
    EXPECT_EQ(share(wall, off), 1.0);
    EXPECT_EQ(share(wall, dark), 1.0);
    EXPECT_EQ(share(wall, negative), 0.0);
}

TEST(Visibility, RefusalsNameTheEntry) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Mesh bad = shapes::sphere(1, 1);
    bad.vertices[5].y = nan;
    EXPECT_NE(refusal([&] {
                  occluders_of({shapes::sphere(1, 1), bad});
              }).find("meshes[1] vertices[5] is"),
              std::string::npos);
    Mesh off = shapes::sphere(1, 1);
    off.triangles[3].z = 99;
    EXPECT_NE(refusal([&] { occluders_of({off}); }).find("meshes[0] triangles[3] is"), std::string::npos);
    EXPECT_NE(refusal([&] { occluders_of({}, glm::dvec3(0, nan, 0)); }).find("origin is (0, nan, 0)"),
              std::string::npos);
    Mesh ends{{{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_NE(refusal([&] { occluders_of({ends}, glm::dvec3(-1.7e308, 0, 0)); }).find("meshes is as far as"),
              std::string::npos);
    const Occluders occluders = occluders_of({shapes::sphere(1, 1)});
    const Light lamp = point_lamp({0, 0, 3});
    EXPECT_NE(refusal([&] {
                  share(occluders, lamp, {0, nan, 0});
              }).find("points[0] is (0, nan, 0)"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  share(occluders, lamp, {}, {nan, 0, 0});
              }).find("normals[0]"),
              std::string::npos);
    EXPECT_NE(refusal([&] { share(occluders, lamp, {}, up, {.samples = 0}); }).find("samples is 0"),
              std::string::npos);
    EXPECT_NE(refusal([&] { share(occluders, lamp, {}, up, {.threads = -1}); }).find("threads is -1"),
              std::string::npos);
    Light broken = lamp;
    broken.power = nan;
    EXPECT_NE(refusal([&] { share(occluders, broken); }).find("power is nan"), std::string::npos);
}

}  // namespace
}  // namespace skinglow
