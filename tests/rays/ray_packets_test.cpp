#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "mesh_shapes.h"
#include "rays/embree_triangles.h"

namespace skinglow {
namespace {

/// Rays from points beside a box: towards it, away from it, and some that end before it.
std::vector<RaySegment> some_rays(std::size_t count) {
    std::vector<RaySegment> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = 0.37F * static_cast<float>(i % 8);
        const std::size_t row = i / 8;
        const auto y = 0.29F * static_cast<float>(row);
        const glm::vec3 direction = glm::normalize(glm::vec3(0.3F, -0.2F, i % 3 == 0 ? -1.0F : 1.0F));
        rays.push_back({{x, y, -1.0F}, direction, 0.01F, i % 5 == 0 ? 0.5F : 100.0F});
    }
    return rays;
}

TEST(RayPackets, SayWhatSingleRaysSay) {
    const shapes::Mesh box = shapes::box({2, 2, 2}, 3);
    const EmbreeTriangles triangles(box.vertices, box.triangles);
    for (const std::size_t count : {0U, 1U, 3U, 8U, 61U}) {
        const std::vector<RaySegment> rays = some_rays(count);
        std::vector<std::uint8_t> result(count, 2);
        triangles.occluded(rays, result);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const RaySegment& ray = rays[i];
            const bool single = triangles.occluded(ray.origin, ray.direction, ray.from, ray.to);
            EXPECT_EQ(result[i], single ? 1 : 0) << i << " of " << count;
            hits += result[i];
        }
        if (count == 61) {
            EXPECT_GT(hits, 10U);
            EXPECT_LT(hits, 50U);
        }
    }
}

TEST(RayPackets, MeetNothingWhereThereIsNothing) {
    const EmbreeTriangles nothing({}, {});
    std::vector<std::uint8_t> result(9, 2);
    nothing.occluded(some_rays(9), result);
    EXPECT_EQ(result, std::vector<std::uint8_t>(9, 0));
}

}  // namespace
}  // namespace skinglow
