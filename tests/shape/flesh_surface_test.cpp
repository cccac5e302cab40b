#include "shape/flesh_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh_shapes.h"
#include "shape/voxel_grid.h"

namespace skinglow {
namespace {

using shapes::Mesh;

std::vector<glm::vec3> random_points(int count, float size) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-size, size);
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) points.emplace_back(uniform(random), uniform(random), uniform(random));
    return points;
}

TEST(Winding, IsOneInsideAndTwoWhereBodiesOverlap) {
    Mesh mesh = shapes::sphere(5, 4);
    mesh.append(shapes::sphere(3, 4));
    const Body body(mesh.view(), 1.0);
    const TriangleTree tree(body);
    double sum_sq = 0;
    for (const glm::vec3& p : random_points(2000, 6)) {
        const float r = glm::length(p);
        if (std::abs(r - 5) < 0.1F || std::abs(r - 3) < 0.1F) continue;
        const double error = tree.winding(p) - (r > 5 ? 0 : (r > 3 ? 1 : 2));
        EXPECT_LT(std::abs(error), 0.2) << r;
        sum_sq += error * error / 2000;
    }
    EXPECT_LT(std::sqrt(sum_sq), 0.03);
}

TEST(Body, TurnsFacesThatAreAgainstTheirNeighbors) {
    Mesh mesh = shapes::sphere(5, 3);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 40)
        std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
    const Body body(mesh.view(), 1.0);
    for (const BodyTriangle& t : body.triangles()) EXPECT_GT(glm::dot(t.normal, body.corner(t, 0)), 0);
}

TEST(Body, TakesRepeatedTrianglesOnceAndMirrorImagesNot) {
    Mesh mesh = shapes::sphere(5, 2);
    const std::size_t count = mesh.triangles.size();
    mesh.append(mesh);
    EXPECT_EQ(Body(mesh.view(), 1.0).triangles().size(), count);
    Mesh mirrored = shapes::sphere(5, 2);
    Mesh inside_out = mirrored;
    inside_out.flip();
    mirrored.append(inside_out);
    EXPECT_TRUE(Body(mirrored.view(), 1.0).triangles().empty());
}

TEST(FleshSurface, RaysPassWallsInsideFleshAndStopAtCavities) {
    Mesh walled = shapes::sphere(5, 4);
    walled.append(shapes::sphere(3, 4));
    const Body body(walled.view(), 1.0);
    const FleshSurface surface(body, 0.5);
    const auto out = surface.nearest({0.1F, 0.2F, 0.0F}, {0, 0, 1});
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->distance, 5, 0.05);
    const Body shell(shapes::shell(5, 2, 4).view(), 1.0);
    const FleshSurface hollow(shell, 0.5);
    const auto in = hollow.nearest({0.1F, 0.2F, -4.0F}, {0, 0, 1});
    ASSERT_TRUE(in);
    EXPECT_NEAR(in->distance, 1, 0.05);
}

TEST(VoxelGrid, HasTheVolumeOfTheFleshWithinTheMargin) {
    const Mesh mesh = shapes::sphere(5, 5);
    const Body body(mesh.view(), 1.0);
    const FleshSurface surface(body, 0.25);
    const VoxelGrid whole(surface, body.positions(), 6, 0.25, 0);
    const double volume = whole.size() * 0.25 * 0.25 * 0.25;
    EXPECT_NEAR(volume / (4.0 / 3 * 3.14159265 * 125), 1.0, 0.01);
    const VoxelGrid rind(surface, body.positions(), 2, 0.25, 0);
    EXPECT_NEAR(rind.size() * 0.25 * 0.25 * 0.25 / volume, 1 - std::pow(3.0 / 5, 3), 0.03);
}

}  // namespace
}  // namespace skinglow
