#include "tiles/texel_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <random>

#include "tiles/tile_layout.h"

namespace skinglow::detail {
namespace {

using Corners = std::array<glm::vec3, 3>;

Corners random_corners(std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(1.0F, 9.0F);
    Corners corners{};
    for (glm::vec3& c : corners) c = {uniform(random), uniform(random), 1.0F};
    return corners;
}

TEST(TexelTriangle, IsReadFromTheFourTexelsAboutEachOfItsPoints) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const Corners corners = random_corners(random);
        const TexelTriangle triangle(corners);
        double u = uniform(random);
        double v = uniform(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const glm::dvec2 point = triangle.at({1 - u - v, u, v});
        EXPECT_GE(triangle.depth(point), -1e-9);
        const glm::dvec2 first = glm::floor(point);
        for (const glm::dvec2 step : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)})
            EXPECT_TRUE(triangle.reads(first + step));
    }
}

TEST(TexelTriangle, IsNotReadFromTexelsThatNoPointOfItNeeds) {
    std::mt19937 random(2);
    int unread = 0;
    for (int i = 0; i < 200; ++i) {
        const TexelTriangle triangle(random_corners(random));
        for (int x = 0; x < 11; ++x) {
            for (int y = 0; y < 11; ++y) {
                if (triangle.reads({x, y})) continue;
                ++unread;
                // The nearest point by largest coordinate is at least a texel away: seen on a fine grid of its points.
                for (double u = 0; u <= 1; u += 0.05) {
                    for (double v = 0; u + v <= 1; v += 0.05) {
                        const glm::dvec2 offset = glm::abs(triangle.at({1 - u - v, u, v}) - glm::dvec2(x, y));
                        EXPECT_GE(std::max(offset.x, offset.y), 1.0);
                    }
                }
            }
        }
    }
    EXPECT_GT(unread, 1000);
}

TEST(TexelTriangle, WeightsGiveTheTexelBackAndNearestIsOnAnEdge) {
    std::mt19937 random(3);
    for (int i = 0; i < 500; ++i) {
        const TexelTriangle triangle(random_corners(random));
        if (triangle.area() < 0.1) continue;
        const glm::dvec2 texel(random() % 10, random() % 10);
        EXPECT_LT(glm::length(triangle.at(triangle.weights(texel)) - texel), 1e-6);
        const glm::dvec3 nearest = triangle.nearest(texel);
        EXPECT_NEAR(nearest.x + nearest.y + nearest.z, 1.0, 1e-12);
        EXPECT_EQ(std::min({nearest.x, nearest.y, nearest.z}), 0.0);
        const double depth = triangle.depth(texel);
        const double distance = glm::length(triangle.at(nearest) - texel);
        if (depth > 0) {
            EXPECT_NEAR(distance, depth, 1e-6);
        } else {
            EXPECT_GE(distance, -depth - 1e-6);
        }
    }
}

TEST(TexelTriangle, WithoutAreaIsItsLongestEdge) {
    for (const Corners& corners : {Corners{glm::vec3(2, 3, 1), glm::vec3(2, 3, 1), glm::vec3(2, 3, 1)},
                                   Corners{glm::vec3(2, 3, 1), glm::vec3(4, 3, 1), glm::vec3(6, 3, 1)}}) {
        const TexelTriangle triangle(corners);
        EXPECT_EQ(triangle.area(), 0.0);
        EXPECT_TRUE(triangle.reads({2, 3}));
        EXPECT_LT(triangle.depth({2, 3}), 0.0);
        EXPECT_EQ(triangle.at(triangle.weights({2, 4})), glm::dvec2(2, 3));
    }
}

TEST(TilePacking, PutsTilesApartAndWithinTheWidth) {
    std::mt19937 random(4);
    std::vector<glm::uvec2> sizes(500);
    for (glm::uvec2& size : sizes) size = {1 + random() % 60, 1 + random() % 20};
    sizes.push_back({1023, 1});
    const PackedTiles packed = pack(sizes);
    std::vector<int> taken(1024 * packed.height, 0);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        ASSERT_LT(packed.corner[i].x + sizes[i].x, 1024U);
        ASSERT_LT(packed.corner[i].y + sizes[i].y, packed.height);
        for (unsigned y = 0; y <= sizes[i].y; ++y) {
            for (unsigned x = 0; x <= sizes[i].x; ++x)
                ++taken[1024 * (packed.corner[i].y + y) + packed.corner[i].x + x];
        }
    }
    EXPECT_EQ(*std::max_element(taken.begin(), taken.end()), 1);
    const auto used = static_cast<double>(std::count(taken.begin(), taken.end(), 1));
    EXPECT_GT(used / static_cast<double>(taken.size()), 0.85);
}

}  // namespace
}  // namespace skinglow::detail
