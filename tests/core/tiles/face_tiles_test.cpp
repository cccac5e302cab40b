#include <gtest/gtest.h>
#include <skinglow/face_tiles.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace skinglow {
namespace {

struct RandomFaces {
    std::vector<glm::dvec3> vertices;
    std::vector<std::uint32_t> sizes;
    std::vector<std::uint32_t> corners;
    std::vector<glm::uvec3> fans;  ///< corners of triangles

    explicit RandomFaces(unsigned seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal(0.0, 3.0);
        const auto below = [&](unsigned bound) { return static_cast<std::uint32_t>(random() % bound); };
        for (std::uint32_t i = 0, count = 3 + below(40); i < count; ++i) {
            // Some at one place.
            vertices.push_back(i > 0 && below(8) == 0
                                   ? vertices[below(i)]
                                   : glm::dvec3(normal(random), normal(random), normal(random)));
        }
        for (std::uint32_t i = 0, count = 1 + below(60); i < count; ++i) {
            sizes.push_back(3 + below(4));
            const auto begin = static_cast<std::uint32_t>(corners.size());
            for (std::uint32_t k = 0; k < sizes.back(); ++k)
                corners.push_back(below(static_cast<unsigned>(vertices.size())));
            for (std::uint32_t k = 1; k + 1 < sizes.back(); ++k)
                fans.push_back({begin, begin + k, begin + k + 1});
        }
    }
};

TEST(FaceTiles, TargetsOfAnyFacesAreFiniteAndServeWhatIsRead) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (unsigned seed = 0; seed < 60; ++seed) {
        const RandomFaces faces(seed);
        const double spacing = std::pow(10.0, 1.5 * uniform(random) - 0.8);
        const FaceTiles layout(faces.vertices, faces.sizes, faces.corners, {},
                               {.unit_mm = 1.0, .spacing_mm = spacing, .max_texels = std::size_t{1} << 19U});
        std::vector<glm::uvec3> triangles;
        std::vector<glm::vec3> texels;
        for (const glm::uvec3& fan : faces.fans) {
            glm::uvec3 triangle(0U);
            for (int k = 0; k < 3; ++k) {
                triangle[k] = faces.corners[fan[k]];
                texels.push_back(layout.texels()[fan[k]]);
            }
            triangles.push_back(triangle);
        }
        const TileTargets targets(MeshView(faces.vertices, triangles), texels, layout.height());
        for (const glm::dvec3& p : targets.points()) ASSERT_TRUE(std::isfinite(glm::length(p)));
        const std::vector<double> ones(targets.points().size(), 1.0);
        std::vector<float> pixels(targets.of_texel().size(), 7.0F);
        targets.spread(ones, 1, 1, pixels);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            double u = uniform(random);
            double v = uniform(random);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const glm::dvec3 at = (1 - u - v) * glm::dvec3(texels[3 * t]) +
                                  u * glm::dvec3(texels[3 * t + 1]) + v * glm::dvec3(texels[3 * t + 2]);
            const auto first =
                static_cast<std::size_t>(at.y) * tile_image_width + static_cast<std::size_t>(at.x);
            for (const std::size_t next :
                 {std::size_t{0}, std::size_t{1}, tile_image_width, tile_image_width + 1})
                ASSERT_EQ(pixels.at(first + next), 1.0F) << "seed " << seed << ", triangle " << t;
        }
        EXPECT_EQ(targets.mixed(), 0.0);
    }
}

TEST(FaceTiles, ValuesAtVerticesStayNotNegative) {
    const RandomFaces faces(3);
    const FaceTiles layout(faces.vertices, faces.sizes, faces.corners);
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec3> texels;
    for (const glm::uvec3& fan : faces.fans) {
        triangles.emplace_back(faces.corners[fan.x], faces.corners[fan.y], faces.corners[fan.z]);
        for (int k = 0; k < 3; ++k) texels.push_back(layout.texels()[fan[k]]);
    }
    const TileTargets targets(MeshView(faces.vertices, triangles), texels, layout.height());
    std::vector<double> values(2 * faces.vertices.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 3 == 0 ? 5.0 : 0.0;
    const std::vector<double> found = targets.at_vertices(values, 2);
    ASSERT_EQ(found.size(), 2 * targets.points().size());
    EXPECT_GE(*std::min_element(found.begin(), found.end()), 0.0);
    EXPECT_GT(*std::max_element(found.begin(), found.end()), 4.0);
}

}  // namespace
}  // namespace skinglow
