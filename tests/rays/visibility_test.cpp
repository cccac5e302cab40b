#include <cmath>

#include "visibility_scenes.h"

namespace skinglow {
namespace {

using namespace visibility_scenes;

TEST(Visibility, HalfPlaneLeavesHalfOfADisk) {
    const Occluders occluders = occluders_of({half_plane(0, 1)});
    const FlatLight disk = area_light(AreaShape::ellipse, 1, 1, 2);
    EXPECT_NEAR(visible(occluders, disk, {}, up, {.samples = 4096}), 0.5, 5e-4);
    EXPECT_NEAR(visible(occluders, disk), 0.5, 0.07);  // the default, from one point
    FlatLight ball = point_light({0, 0, 2});
    ball.radius = 0.5;
    EXPECT_NEAR(visible(occluders, ball, {}, up, {.samples = 4096}), 0.5, 5e-4);
    ball.soft_falloff = false;
    EXPECT_NEAR(visible(occluders, ball, {}, up, {.samples = 4096}), 0.5, 5e-4);
    FlatLight sun;
    sun.kind = LightKind::sun;
    sun.sun_angle = 0.3;
    EXPECT_NEAR(visible(occluders, sun, {}, up, {.samples = 4096}), 0.5, 5e-4);
}

TEST(Visibility, HalfARectangleIsAsBrightAsThatHalfAlone) {
    // What is left of a near, oblique light, against the closed form of a light half as wide.
    for (const AreaShape shape : {AreaShape::rectangle, AreaShape::ellipse}) {
        for (const double spread : {pi, 1.6}) {
            FlatLight whole = area_light(shape, 2, 1, 1);
            whole.spread = spread;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.6, 0.3, 1));
            const Occluders left = occluders_of({half_plane(0, 0.5)});
            const Occluders right = occluders_of({sheet({-1000, -1000, 0.5}, {1000, 0, 0}, {0, 2000, 0})});
            const double a = visible(left, whole, {}, normal, {.samples = 4096});
            const double b = visible(right, whole, {}, normal, {.samples = 4096});
            EXPECT_NEAR(a + b, 1.0, 1e-3);  // both stop a ray along their common edge
            if (shape == AreaShape::ellipse || spread < pi) continue;
            FlatLight half = whole;
            half.size_x = 1;
            half.position.x = -0.5;
            half.power = 0.5;
            const double expected =
                irradiance_at({half}, {}, normal).r / irradiance_at({whole}, {}, normal).r;
            EXPECT_GT(expected, 0.6);
            EXPECT_NEAR(a, expected, 1e-3);
        }
    }
}

TEST(Visibility, BallEclipsesASun) {
    // Seen on its axis a round patch brings pi L sin^2 of its radius, so that is what a smaller one takes.
    FlatLight sun;
    sun.kind = LightKind::sun;
    sun.sun_angle = 0.6;
    const double sine = 0.2;
    const Occluders occluders = occluders_of({moved(shapes::sphere(2 * sine, 6), {0, 0, 2})});
    const double expected = 1.0 - sine * sine / std::pow(std::sin(0.3), 2);
    EXPECT_NEAR(visible(occluders, sun, {}, up, {.samples = 4096}), expected, 2e-3);
}

TEST(Visibility, BallBeforeAPointLampHidesItAndBesideItDoesNot) {
    const FlatLight light = point_light({0, 0, 4});
    EXPECT_EQ(visible(occluders_of({moved(shapes::sphere(0.5, 3), {0, 0, 2})}), light), 0.0);
    EXPECT_EQ(visible(occluders_of({moved(shapes::sphere(0.5, 3), {0.6, 0, 2})}), light), 1.0);
    EXPECT_EQ(visible(occluders_of({}), light), 1.0);
}

TEST(Visibility, WhatStandsBehindTheLampOrTouchesItDoesNotCount) {
    const Occluders ceiling = occluders_of({sheet({-50, -50, 3}, {100, 0, 0}, {0, 100, 0})});
    for (const double height : {2.0, 2.99, 3.0}) {
        EXPECT_EQ(visible(ceiling, point_light({0.3, 0.2, height})), 1.0) << height;
        EXPECT_EQ(visible(ceiling, area_light(AreaShape::rectangle, 2, 1, height)), 1.0) << height;
    }
    EXPECT_EQ(visible(ceiling, point_light({0.3, 0.2, 3.01})), 0.0);
    // Nor does what the point lies on.
    const Occluders floor = occluders_of({sheet({-50, -50, 0}, {100, 0, 0}, {0, 100, 0})});
    EXPECT_EQ(visible(floor, point_light({0.3, 0.2, 2}), {5, 7, 0}), 1.0);
}

TEST(Visibility, BallLampEndsAtItsSurface) {
    FlatLight ball = point_light({0, 0, 2});
    ball.radius = 0.5;
    ball.soft_falloff = false;
    // A sheet within the ball is behind its near side, one before it is not.
    EXPECT_EQ(visible(occluders_of({sheet({-5, -5, 2.2}, {10, 0, 0}, {0, 10, 0})}), ball), 1.0);
    EXPECT_EQ(visible(occluders_of({sheet({-5, -5, 1.4}, {10, 0, 0}, {0, 10, 0})}), ball), 0.0);
    // From within it light comes from everywhere; what is farther than the ball's surface does not stop it.
    EXPECT_EQ(visible(occluders_of({shapes::sphere(5, 3)}), ball, {0, 0, 2.1}), 1.0);
    EXPECT_EQ(visible(occluders_of({moved(shapes::sphere(0.05, 3), {0, 0, 2.1})}), ball, {0, 0, 2.1}), 0.0);
}

TEST(Visibility, MeshesLeftOutDoNotCount) {
    const std::vector<Mesh> meshes{moved(shapes::sphere(0.5, 3), {0, 0, 1}), half_plane(-1, 2),
                                   moved(shapes::sphere(0.5, 3), {0, 0, 3})};
    const Occluders occluders = occluders_of(meshes);
    EXPECT_EQ(occluders.meshes(), 3U);
    const FlatLight light = point_light({0, 0, 4});
    EXPECT_EQ(visible(occluders, light), 0.0);
    EXPECT_EQ(visible(occluders, light, {}, up, {.excluded = {0, 1}}), 0.0);
    EXPECT_EQ(visible(occluders, light, {}, up, {.excluded = {1, 2}}), 0.0);
    EXPECT_EQ(visible(occluders, light, {}, up, {.excluded = {2, 0, 1}}), 1.0);
    EXPECT_NE(
        refusal([&] { visible(occluders, light, {}, up, {.excluded = {3}}); }).find("is 3; allowed: below"),
        std::string::npos);
}

TEST(Visibility, MeanCountsPlacesByWhatTheLampWouldBring) {
    const Occluders wall = occluders_of({half_plane(1, 1)});
    const FlatLight light = point_light({0, 0, 2});
    // Lit; in the wall's shadow; facing away, which the wall cannot help.
    const std::vector<glm::dvec3> points{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}};
    const std::vector<glm::dvec3> normals{{0, 0, 5}, {-1, 0, 1}, {0, 0, -1}};
    const VisibleFraction found = visible_fraction(wall, {light}, points, normals);
    EXPECT_EQ(found.at_points, (std::vector<double>{1, 0, 1}));
    const double lit = irradiance_at({light}, points[0], normals[0]).r;
    const double dark = irradiance_at({light}, points[1], normals[1]).r;
    EXPECT_NEAR(found.mean[0], lit / (lit + dark), 1e-12);
    const std::vector<glm::dvec3> averted(3, -up);
    EXPECT_EQ(visible_fraction(wall, {light}, points, averted).mean[0], 1.0);
    EXPECT_EQ(visible_fraction(wall, {light}, points, std::vector<glm::dvec3>(3, glm::dvec3(0))).mean[0],
              1.0);
}

TEST(Visibility, MeanOverPlacesIsFarBetterThanOne) {
    // The shadow's edge crosses a row of points; the mean of their fractions is the mean of a closed form.
    FlatLight disk = area_light(AreaShape::rectangle, 1, 1, 2);
    const Occluders wall = occluders_of({half_plane(0, 1)});
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 256; ++i) points.emplace_back(-0.5 + (i + 0.5) / 256, 0.0, 0.0);
    const std::vector<glm::dvec3> normals(points.size(), up);
    const VisibleFraction found = visible_fraction(wall, {disk}, points, normals);
    EXPECT_NEAR(found.mean[0], 0.5, 2e-3);  // by symmetry
}

}  // namespace
}  // namespace skinglow
