#include "rays/ray_scene.h"

#include <gtest/gtest.h>
#include <skinglow/thickness.h>

#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "mesh_shapes.h"

namespace skinglow {
namespace {

using shapes::Mesh;

Mesh moved(Mesh mesh, const glm::dvec3& offset) {
    for (glm::dvec3& v : mesh.vertices) v += offset;
    return mesh;
}

/// Distance at which a ray leaves the flesh, from the vertex at a position; -1 where it does not.
double exit_distance(const Mesh& mesh, const glm::dvec3& from, const glm::dvec3& direction) {
    const WeldedMesh welded(mesh.view());
    const RayScene scene(welded);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (mesh.vertices[i] != from) continue;
        const std::uint32_t vertex = welded.welded_of()[i];
        const auto exit = scene.exit_triangle(vertex, direction, {});
        if (!exit) return -1.0;
        const WeldedTriangle& t = welded.triangles()[*exit];
        const glm::dvec3& origin = welded.positions()[vertex];
        return (t.plane - glm::dot(t.unit_normal, origin)) / glm::dot(t.unit_normal, direction) *
               welded.scale();
    }
    throw std::logic_error("no such vertex");
}

const glm::dvec3 middle_of_face(5, 5, 10);
const glm::dvec3 down(0, 0, -1);

Mesh body() {
    return shapes::box({10, 10, 10}, 2);
}

TEST(ExitTriangle, PassesBodiesThatShareASurface) {
    // Two plates on each other, of different grids: where one ends the other begins, at the same distance.
    Mesh mesh = body();
    mesh.append(moved(shapes::box({4, 4, 2}, 3), {3, 3, 2}));
    mesh.append(moved(shapes::box({4, 4, 2}, 1), {3, 3, 4}));
    EXPECT_NEAR(exit_distance(mesh, middle_of_face, down), 10.0, 1e-9);
}

TEST(ExitTriangle, PassesBodiesThinnerThanAHitIsExact) {
    for (const double thin : {1e-4, 1e-6, 1e-8, 0.0}) {
        Mesh mesh = body();
        mesh.append(moved(shapes::box({4, 4, thin}, 3), {3, 3, 5}));
        EXPECT_NEAR(exit_distance(mesh, middle_of_face, down), 10.0, 1e-9) << thin;
    }
}

TEST(ExitTriangle, EndsBeforeACavityAndABodyThatTouchesIsOne) {
    Mesh mesh = body();
    Mesh cavity = moved(shapes::box({4, 4, 4}, 3), {3, 3, 3});
    cavity.flip();
    mesh.append(cavity);
    EXPECT_NEAR(exit_distance(mesh, middle_of_face, down), 3.0, 1e-9);
    Mesh stacked = body();
    stacked.append(moved(shapes::box({10, 10, 5}, 3), {0, 0, -5}));
    EXPECT_NEAR(exit_distance(stacked, middle_of_face, down), 15.0, 1e-9);
}

TEST(ExitTriangle, CountsASurfaceOnceWhereTheRayMeetsItsEdges) {
    // Straight down the ray passes through a corner of each grid of an even number of cells, and along an
    // edge of two triangles of the others.
    for (const std::uint32_t cells : {1U, 2U, 3U, 4U}) {
        Mesh mesh = body();
        for (int i = 0; i < 4; ++i) mesh.append(moved(shapes::box({4, 4, 1}, cells), {3, 3, 1.0 + 2 * i}));
        EXPECT_NEAR(exit_distance(mesh, middle_of_face, down), 10.0, 1e-9) << cells;
    }
}

TEST(ExitTriangle, IsNoneWhereTheMeshIsOpenOrTheRayGoesOut) {
    EXPECT_EQ(exit_distance(body(), middle_of_face, -down), -1.0);
    const Mesh plane{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(exit_distance(plane, {0, 0, 0}, down), -1.0);
}

TEST(Embree, IsRefusedWhereItCannotServe) {
    const auto refusal = [](long version, long filters) -> std::string {
        try {
            require_embree(version, filters);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "accepted";
    };
    int accepted = 0;
    for (const long version : {2L, 3L, 4L, 5L}) {
        const std::string text = refusal(version, 1);
        if (text == "accepted") {
            ++accepted;
            EXPECT_NE(refusal(version, 0).find("EMBREE_FILTER_FUNCTION=ON"), std::string::npos);
        } else {
            EXPECT_NE(text.find("version " + std::to_string(version)), std::string::npos) << text;
            EXPECT_NE(text.find("static Embree"), std::string::npos) << text;
        }
    }
    EXPECT_EQ(accepted, 1);
}

}  // namespace
}  // namespace skinglow
