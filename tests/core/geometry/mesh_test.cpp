#include <gtest/gtest.h>
#include <skinglow/mesh.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include "geometry/weld.h"

namespace skinglow {
namespace {

const std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};

std::string refusal(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles,
                    const char* prefix = "") {
    try {
        TriangleMesh(std::move(vertices), std::move(triangles), prefix);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Mesh, IsCheckedWhenItIsMade) {
    EXPECT_EQ(refusal(corners, {{0, 1, 2}}), "accepted");
    EXPECT_EQ(refusal(corners, {{0, 1, 2}, {0, 4, 1}}),
              "triangles[1] is (0, 4, 1); allowed: indices below 4, the number of vertices");
    EXPECT_EQ(refusal({{0, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}}, {}, "meshes[2] "),
              "meshes[2] vertices[1] is (0, nan, 0); allowed: three finite numbers");
    // A span that claims more than 32 bits count is refused before it is read.
    const std::size_t many = std::size_t{1} << 32U;
    EXPECT_THROW(MeshView(std::span(corners.data(), many), {}), std::invalid_argument);
}

TEST(Mesh, ACopyHoldsItsOwnArrays) {
    TriangleMesh copy;
    {
        const TriangleMesh mesh(corners, {{0, 1, 2}});
        copy = mesh;
    }
    const MeshView view = copy;
    EXPECT_EQ(view.vertices().data(), copy.vertices().data());
    EXPECT_EQ(view.triangles().size(), 1U);
}

TEST(Mesh, BoxIsOfWhatTrianglesUse) {
    const TriangleMesh mesh(corners, {{0, 1, 2}});
    const TriangleMesh stray(corners, {});
    const std::array<MeshView, 2> both = {stray, mesh};
    const auto box = box_of(both);
    ASSERT_TRUE(box.has_value());
    EXPECT_EQ(box->min, glm::dvec3(0, 0, 0));
    EXPECT_EQ(box->max, glm::dvec3(1, 1, 0));
    EXPECT_FALSE(box_of(std::span(both).first(1)).has_value());
}

TEST(Weld, KeepsEachPointOnceInOrder) {
    std::vector<glm::dvec3> points = {{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {-0.0, 0, -0.0}, {3, 2, 1}};
    const Weld few = weld<glm::dvec3>(points);
    EXPECT_EQ(few.first, (std::vector<std::uint32_t>{0, 1, 4}));
    EXPECT_EQ(few.index, (std::vector<std::uint32_t>{0, 1, 0, 1, 2}));
    EXPECT_TRUE(weld(std::span<const glm::dvec3>()).index.empty());
    // A grid of small whole numbers, three times over: bits that a weak hash would throw together.
    points.clear();
    for (int i = 0; i < 3 * 32768; ++i) points.emplace_back(i % 32, i / 32 % 32, i / 1024 % 32);
    const Weld grid = weld<glm::dvec3>(points);
    EXPECT_EQ(grid.first.size(), 32768U);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points[grid.first[grid.index[i]]], points[i]);
}

}  // namespace
}  // namespace skinglow
