#include <gtest/gtest.h>
#include <skinglow/environment.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "random_lights.h"

using namespace skinglow;

namespace {

using std::numbers::pi;

using Radiance = std::function<double(const glm::dvec3&)>;

/// A function of all nine harmonics, and no other.
double three_bands(const glm::dvec3& d) {
    return 1 + 0.5 * d.x - 0.3 * d.y + 0.2 * d.z + 0.4 * d.x * d.z - 0.25 * d.x * d.y + 0.15 * d.y * d.z +
           0.35 * (d.x * d.x - d.y * d.y) + 0.1 * (3 * d.z * d.z - 1);
}

/// float32, of four channels, the bottom row first: as Blender holds it.
std::vector<float> blender_pixels(const Radiance& radiance, std::size_t width, std::size_t height) {
    std::vector<float> values;
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column) {
            const double u = (static_cast<double>(column) + 0.5) / static_cast<double>(width);
            const double v = (static_cast<double>(row) + 0.5) / static_cast<double>(height);
            const auto value = static_cast<float>(radiance(Environment::direction(u, v)));
            values.insert(values.end(), {value, 2 * value, 3 * value, 1.0F});
        }
    }
    return values;
}

glm::dmat3 random_rotation(RandomScene& random) {
    const glm::dvec3 x = random.unit_vector();
    const glm::dvec3 y = glm::normalize(glm::cross(x, random.unit_vector()));
    return {x, y, glm::cross(x, y)};
}

}  // namespace

TEST(Environment, ConstantColorGivesPiTimesRadiance) {
    const std::vector<glm::dvec3> pixels(8 * 4, glm::dvec3(0.5, 1.0, 2.0));
    const Environment image = Environment::from_equirectangular(pixels, 8, 4);
    RandomScene random(9);
    for (int i = 0; i < 50; ++i) {
        EXPECT_NEAR(image.irradiance(random.unit_vector()).b, 2 * pi, 1e-12);
        EXPECT_NEAR(Environment(glm::dvec3(2.0)).irradiance(random.unit_vector()).b, 2 * pi, 1e-12);
    }
    EXPECT_NEAR(image.mean_irradiance().r, 0.5 * pi, 1e-12);
}

TEST(Environment, ImagesOfTheFirstThreeBandsAreExact) {
    // Radiance 1 + 0.5 x - 0.3 y + 0.2 z + 0.4 x z: irradiance pi + 2 pi / 3 (...) + pi / 4 (...).
    constexpr std::size_t width = 512;
    constexpr std::size_t height = 256;
    std::vector<glm::dvec3> pixels;
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column) {
            const glm::dvec3 d = Environment::direction((static_cast<double>(column) + 0.5) / width,
                                                        1 - (static_cast<double>(row) + 0.5) / height);
            pixels.emplace_back(1 + 0.5 * d.x - 0.3 * d.y + 0.2 * d.z + 0.4 * d.x * d.z);
        }
    }
    const Environment image = Environment::from_equirectangular(pixels, width, height);
    RandomScene random(10);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 n = random.unit_vector();
        const double expected =
            pi + 2 * pi / 3 * (0.5 * n.x - 0.3 * n.y + 0.2 * n.z) + pi / 4 * 0.4 * n.x * n.z;
        EXPECT_NEAR(image.irradiance(n).g, expected, 2e-4);
    }
    EXPECT_THROW(Environment::from_equirectangular(pixels, width, height + 1), std::invalid_argument);
    EXPECT_THROW(Environment(glm::dvec3(-1.0)), std::invalid_argument);
}

TEST(Environment, FloatPixelsFromTheBottomAreTheSameImage) {
    constexpr std::size_t width = 64;
    constexpr std::size_t height = 32;
    const std::vector<float> values = blender_pixels(three_bands, width, height);
    std::vector<glm::dvec3> pixels;
    for (std::size_t row = height; row-- > 0;) {
        for (std::size_t column = 0; column < width; ++column) {
            const float* p = &values[4 * (row * width + column)];
            pixels.emplace_back(p[0], p[1], p[2]);
        }
    }
    const Environment expected = Environment::from_equirectangular(pixels, width, height);
    const Environment found =
        Environment::from_equirectangular(RadianceImage{values, width, height, 4, true});
    EXPECT_EQ(found.coefficients(), expected.coefficients());
    const std::vector<float> gray(8, 0.5F);
    EXPECT_NEAR(Environment::from_equirectangular(RadianceImage{gray, 2, 2, 2}).mean_irradiance().g, pi / 2,
                1e-14);
}

TEST(Environment, TurningIsExact) {
    RandomScene random(21);
    for (int i = 0; i < 50; ++i) {
        std::array<glm::dvec3, 9> coefficients;
        for (glm::dvec3& each : coefficients) each = random.unit_vector();
        coefficients[0] = glm::dvec3(20.0);  // bright enough that nothing is cut off at 0
        glm::dmat3 turn = random_rotation(random);
        if (i % 2 == 1) turn[0] = -turn[0];  // mirrored
        const Environment still(coefficients);
        const Environment turned = still.rotated(turn);
        const glm::dvec3 normal = random.unit_vector();
        const glm::dvec3 expected = still.irradiance(normal);
        const glm::dvec3 found = turned.irradiance(turn * normal);
        EXPECT_NEAR(found.r, expected.r, 1e-12);
        EXPECT_NEAR(found.b, expected.b, 1e-12);
        const Environment back = turned.rotated(glm::transpose(turn));
        for (std::size_t j = 0; j < 9; ++j) {
            EXPECT_NEAR(back.coefficients()[j].g, coefficients[j].g, 1e-13) << j;
        }
    }
}

TEST(Environment, AMirrorBallShowsTheSameWorld) {
    constexpr std::size_t size = 256;
    std::vector<float> values;
    for (std::size_t row = 0; row < size; ++row) {
        for (std::size_t column = 0; column < size; ++column) {
            const double x = 2 * (static_cast<double>(column) + 0.5) / size - 1;
            const double z = 1 - 2 * (static_cast<double>(row) + 0.5) / size;
            const double y = -std::sqrt(std::max(1 - x * x - z * z, 0.0));
            const glm::dvec3 sight(0, 1, 0);
            const glm::dvec3 ball(x, y, z);
            // Outside the ball there is no world: a value that would show.
            const bool on_ball = x * x + z * z <= 1;
            const glm::dvec3 reflected = sight - 2 * glm::dot(sight, ball) * ball;
            const float value = on_ball ? static_cast<float>(three_bands(reflected)) : 1e6F;
            values.insert(values.end(), {value, value, value});
        }
    }
    const Environment found = Environment::from_mirror_ball({values, size, size, 3});
    constexpr std::size_t width = 512;
    const std::vector<float> flat = blender_pixels(three_bands, width, width / 2);
    const Environment expected =
        Environment::from_equirectangular(RadianceImage{flat, width, width / 2, 4, true});
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(found.coefficients()[i].r, expected.coefficients()[i].r, 2e-3) << i;
    }
}

TEST(Environment, BadImagesAndRotationsAreNamed) {
    std::vector<float> values(6, 1.0F);
    EXPECT_THROW(Environment::from_equirectangular(RadianceImage{values, 2, 2, 3}), std::invalid_argument);
    EXPECT_THROW(Environment::from_equirectangular(RadianceImage{values, 0, 2, 3}), std::invalid_argument);
    EXPECT_THROW(Environment::from_equirectangular(RadianceImage{{}, 1U << 31, 1U << 31, 4}),
                 std::invalid_argument);
    EXPECT_THROW(Environment::from_mirror_ball({values, 3, 1, 3}), std::invalid_argument);
    values[4] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(Environment::from_equirectangular(RadianceImage{values, 2, 1, 3}), std::invalid_argument);
    const Environment even(glm::dvec3(1.0));
    EXPECT_THROW(even.rotated(glm::dmat3(1.1)), std::invalid_argument);
    EXPECT_THROW(even.rotated(glm::dmat3(std::nan(""))), std::invalid_argument);
}
