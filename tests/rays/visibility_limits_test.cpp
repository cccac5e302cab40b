#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "visibility_scenes.h"

namespace skinglow {
namespace {

using namespace visibility_scenes;

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
            EXPECT_EQ(visible(occluders, point_light(to), from, to - from), hit ? 0.0 : 1.0) << round;
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
    // More occluders never let more through.
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
        EXPECT_EQ(visible(occluders, point_light(where + glm::dvec3(0, 0, 1)), where), 0.0);
        EXPECT_EQ(
            visible(occluders, point_light(where + glm::dvec3(0, 0, 1)), where + glm::dvec3(0.03, 0, 0)),
            1.0);
        EXPECT_EQ(visible(occluders, point_light(where + glm::dvec3(0, 0, 1e6)), where), 0.0);
        EXPECT_EQ(visible(occluders, point_light(where + glm::dvec3(0, 0, -3)), where, -up), 0.0);
    }
}

TEST(Visibility, ExtremesGiveAShare) {
    const Mesh ball = shapes::sphere(1, 3);
    const Occluders occluders = occluders_of({ball});
    EXPECT_EQ(visible(occluders, point_light({0.2, 0, 0}), {0, 0, 3}, -up), 0.0);  // a light inside the mesh
    EXPECT_EQ(visible(occluders, point_light({0.2, 0, 0}), {0, 0, 0.5}, -up), 1.0);  // and the point, too
    EXPECT_EQ(visible(occluders, point_light({3, 0, 0}), {3, 0, 0}), 1.0);           // at distance 0
    EXPECT_EQ(visible(occluders, point_light({0, 0, 1e100}), {0, 0, -3}), 0.0);
    EXPECT_EQ(visible(occluders, point_light({0, 0, 1e100}), {3, 0, -3}), 1.0);
    EXPECT_EQ(visible(occluders, point_light({0, 0, 2}), {0, 0, -1e6}), 0.0);
    FlatLight wide = area_light(AreaShape::ellipse, 1e9, 1e9, 2);
    const double seen = visible(occluders, wide, {0, 0, -2}, up, {.samples = 256});
    EXPECT_TRUE(seen > 0.9 && seen <= 1.0) << seen;
    for (const double size : {1e-30, 1e-150, 1e150, 1e300}) {
        const Occluders scaled = occluders_of({moved(ball, {}, size)});
        FlatLight sun;
        sun.kind = LightKind::sun;
        EXPECT_EQ(visible(scaled, sun, {0, 0, -2 * size}), 0.0) << size;
        EXPECT_EQ(visible(scaled, sun, {2 * size, 0, -2 * size}), 1.0) << size;
    }
    FlatLight far_up = point_light({0, 0, 1e308});
    for (const double x : {-1e308, 1e308}) {
        const double value = visible(occluders, far_up, {x, 0, 0});
        EXPECT_TRUE(value >= 0.0 && value <= 1.0);
    }
}

TEST(Visibility, TrianglesWithoutAreaStopNothing) {
    const Mesh thin{{{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}, {1e300, 7, 1}}, {{0, 1, 2}, {0, 0, 1}, {2, 2, 2}}};
    const Occluders occluders = occluders_of({thin, {}, {{{0, 0, 1}}, {}}});
    EXPECT_EQ(occluders.triangles(), 0U);
    EXPECT_EQ(visible(occluders, point_light({0, 0, 2})), 1.0);
    // A vertex that no triangle uses costs the others nothing.
    Mesh ball = moved(shapes::sphere(0.5, 3), {0, 0, 1});
    ball.vertices.emplace_back(1e300, 0, 0);
    EXPECT_EQ(visible(occluders_of({ball}), point_light({0, 0, 2})), 0.0);
}

TEST(Visibility, LampsThatGiveNothingAreNotTraced) {
    const Occluders wall = occluders_of({half_plane(-1, 1)});
    FlatLight off = point_light({0, 0, 2});
    off.visible = false;
    FlatLight dark = off;
    dark.visible = true;
    dark.power = 0;
    FlatLight negative = dark;
    negative.power = -5;
    EXPECT_EQ(visible(wall, off), 1.0);
    EXPECT_EQ(visible(wall, dark), 1.0);
    EXPECT_EQ(visible(wall, negative), 0.0);
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
    const FlatLight light = point_light({0, 0, 3});
    EXPECT_NE(refusal([&] {
                  visible(occluders, light, {0, nan, 0});
              }).find("points[0] is (0, nan, 0)"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  visible(occluders, light, {}, {nan, 0, 0});
              }).find("normals[0]"),
              std::string::npos);
    EXPECT_NE(refusal([&] { visible(occluders, light, {}, up, {.samples = 0}); }).find("samples is 0"),
              std::string::npos);
    EXPECT_NE(refusal([&] { visible(occluders, light, {}, up, {.threads = -1}); }).find("threads is -1"),
              std::string::npos);
    FlatLight broken = light;
    broken.power = nan;
    EXPECT_NE(refusal([&] { visible(occluders, broken); }).find("power is nan"), std::string::npos);
}

}  // namespace
}  // namespace skinglow
