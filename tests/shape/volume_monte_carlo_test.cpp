// The reference of light in a shape, checked where the answer is known: plane slabs, balls in balance, balls
// that only absorb, and a ball walked through without a mesh.

#include "shape/volume_monte_carlo.h"

#include <gtest/gtest.h>
#include <skinglow/slab.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "core/mesh_shapes.h"

namespace skinglow::testing {
namespace {

/// A wide plate, lit from below in its middle alone: what leaves above is T of a plate without end, as far as
/// light does not reach its sides.
double plate_transmittance(const TurbidMedium& medium, double thickness_mm, std::int64_t photons) {
    const shapes::Mesh mesh = shapes::box({60, 60, thickness_mm}, 30);
    std::vector<double> irradiance(mesh.vertices.size(), 0.0);
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        const glm::dvec3& p = mesh.vertices[i];
        const bool middle = std::abs(p.x - 30) < 7 && std::abs(p.y - 30) < 7;
        if (p.z == 0.0 && middle) irradiance[i] = 1.0;
    }
    const Exitance exitance =
        volume_monte_carlo(mesh.vertices, mesh.triangles, irradiance, medium, {.photons = photons});
    double above = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3& a = mesh.vertices[t.x];
        const glm::dvec3& b = mesh.vertices[t.y];
        const glm::dvec3& c = mesh.vertices[t.z];
        if (a.z != thickness_mm || b.z != thickness_mm || c.z != thickness_mm) continue;
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        for (int k = 0; k < 3; ++k)
            above += area / 3 * 0.5 * (exitance.half[0][t[k]] + exitance.half[1][t[k]]);
    }
    EXPECT_NEAR(exitance.left + exitance.absorbed + exitance.lost, exitance.entered, 0.02 * exitance.entered);
    return above / exitance.incident;
}

double exact(const TurbidMedium& medium, double thickness_mm) {
    const Layer layer{.refractive_index = medium.refractive_index,
                      .absorption = medium.absorption,
                      .scattering = medium.scattering,
                      .anisotropy = medium.anisotropy,
                      .thickness = thickness_mm};
    return slab({&layer, 1}, Incidence::diffuse(), 1, 1, 32).transmittance;
}

TEST(VolumeMonteCarlo, PlatesTransmitWhatTheTransportSolutionSays) {
    struct Case {
        TurbidMedium medium;
        double thickness_mm;
        std::int64_t photons;
    };
    for (const Case& c : {Case{{.absorption = 0.032, .scattering = 0.74}, 1.0, 100000},
                          Case{{.absorption = 0.032, .scattering = 0.74}, 4.0, 60000},
                          Case{{.absorption = 0.17, .scattering = 0.88}, 2.0, 100000},
                          Case{{.absorption = 0.48, .scattering = 1.01}, 4.0, 300000},
                          Case{{.absorption = 0.1, .scattering = 4.0, .anisotropy = 0.8}, 2.0, 60000}}) {
        const double expected = exact(c.medium, c.thickness_mm);
        EXPECT_NEAR(plate_transmittance(c.medium, c.thickness_mm, c.photons), expected, 0.01 * expected)
            << c.medium.absorption << " /mm, " << c.thickness_mm << " mm";
    }
}

TEST(VolumeMonteCarlo, SmoothPlatesTransmitWhatTheTransportSolutionSays) {
    for (const double thickness_mm : {1.0, 3.0}) {
        const TurbidMedium medium{
            .absorption = 0.05, .scattering = 1.0, .refractive_index = 1.4, .rough = false};
        const double expected = exact(medium, thickness_mm);
        EXPECT_NEAR(plate_transmittance(medium, thickness_mm, 60000), expected, 0.01 * expected);
    }
}

double mean_exitance(const Exitance& exitance, std::size_t vertices) {
    return (std::accumulate(exitance.half[0].begin(), exitance.half[0].end(), 0.0) +
            std::accumulate(exitance.half[1].begin(), exitance.half[1].end(), 0.0)) /
           (2.0 * static_cast<double>(vertices));
}

TEST(VolumeMonteCarlo, LitFromAllSidesABodyThatDoesNotAbsorbGivesBackWhatItGets) {
    const shapes::Mesh ball = shapes::sphere(3.0, 3);
    const std::vector<double> irradiance(ball.vertices.size(), 2.0);
    for (const TurbidMedium& medium :
         {TurbidMedium{.scattering = 1.0}, TurbidMedium{.scattering = 1.0, .refractive_index = 1.4},
          TurbidMedium{.scattering = 1.0, .refractive_index = 1.4, .rough = false}}) {
        const Exitance exitance =
            volume_monte_carlo(ball.vertices, ball.triangles, irradiance, medium, {.photons = 40000});
        EXPECT_NEAR(mean_exitance(exitance, ball.vertices.size()), 2.0 * exitance.entered / exitance.incident,
                    0.02);
        EXPECT_NEAR(exitance.left, exitance.entered, 0.01 * exitance.entered);
        EXPECT_EQ(exitance.lost, 0.0);
    }
}

TEST(VolumeMonteCarlo, ABallThatOnlyAbsorbsFollowsBeersLaw) {
    constexpr double radius = 3.0;
    const shapes::Mesh ball = shapes::sphere(radius, 5);
    const std::vector<double> irradiance(ball.vertices.size(), 1.0);
    for (const double absorption : {0.0, 0.1, 1.0}) {
        const Exitance exitance =
            volume_monte_carlo(ball.vertices, ball.triangles, irradiance,
                               {.absorption = absorption, .scattering = 0.0}, {.photons = 100000});
        // Chords of a ball lit diffusely: 2 radius mu, mu distributed as 2 mu.
        const double x = 2.0 * radius * absorption;
        const double expected = x == 0 ? 1.0 : 2.0 / (x * x) * (1.0 - (1.0 + x) * std::exp(-x));
        EXPECT_NEAR(exitance.left / exitance.incident, expected, 0.01 * expected) << absorption;
        EXPECT_NEAR(exitance.left + exitance.absorbed, exitance.entered, 0.01 * exitance.entered);
    }
}

/// Light of a sun along +x on a ball, and what leaves it weighted by how far back: smooth on the mesh, so
/// that neither the terminator nor the vertices are in the way.
double lit(const glm::dvec3& unit) {
    return std::max(0.0, unit.x);
}
double back(const glm::dvec3& unit) {
    return std::max(0.0, -unit.x);
}

/// What leaves in the back per flux that strikes the front: photons walked through an exact ball one by one.
double back_flux_without_mesh(double radius, const TurbidMedium& medium, int photons) {
    std::mt19937_64 random(99);
    std::uniform_real_distribution<double> uniform(1e-12, 1.0);
    const auto sphere = [&] {
        const double z = 2.0 * uniform(random) - 1.0;
        const double angle = 2.0 * std::numbers::pi * uniform(random);
        const double r = std::sqrt(1.0 - z * z);
        return glm::dvec3(z, r * std::cos(angle), r * std::sin(angle));
    };
    const double extinction = medium.absorption + medium.scattering;
    double flux = 0;
    for (int i = 0; i < photons; ++i) {
        glm::dvec3 normal = sphere();
        normal.x = std::sqrt(uniform(random));
        const double ring =
            std::sqrt((1.0 - normal.x * normal.x) / (normal.y * normal.y + normal.z * normal.z));
        normal = {normal.x, normal.y * ring, normal.z * ring};
        glm::dvec3 position = radius * normal;
        glm::dvec3 direction = glm::normalize(sphere() - normal * (1.0 + 1e-12));  // cosine, inward
        for (;;) {
            const double b = glm::dot(position, direction);
            const double way =
                -b + std::sqrt(std::max(0.0, b * b + radius * radius - glm::dot(position, position)));
            const double flight = -std::log(uniform(random)) / extinction;
            if (flight >= way) {
                flux += back((position + way * direction) / radius);
                break;
            }
            position += flight * direction;
            if (uniform(random) * extinction < medium.absorption) break;
            direction = sphere();
        }
    }
    return flux / photons;
}

double back_flux(const shapes::Mesh& ball, double radius, std::size_t lit_vertices,
                 const TurbidMedium& medium) {
    std::vector<double> irradiance(ball.vertices.size(), 0.0);
    for (std::size_t i = 0; i < lit_vertices; ++i) irradiance[i] = lit(ball.vertices[i] / radius);
    const Exitance exitance =
        volume_monte_carlo(ball.vertices, ball.triangles, irradiance, medium, {.photons = 150000});
    double flux = 0;
    for (const glm::uvec3& t : ball.triangles) {
        const glm::dvec3& a = ball.vertices[t.x];
        const double area = 0.5 * glm::length(glm::cross(ball.vertices[t.y] - a, ball.vertices[t.z] - a));
        for (int k = 0; k < 3; ++k) {
            flux += back(ball.vertices[t[k]] / radius) * area / 3 * 0.5 *
                    (exitance.half[0][t[k]] + exitance.half[1][t[k]]);
        }
    }
    return flux / exitance.incident;
}

TEST(VolumeMonteCarlo, ABallIsWhatAWalkWithoutMeshFinds) {
    for (const double absorption : {0.03, 0.3}) {
        const TurbidMedium medium{.absorption = absorption, .scattering = 0.9};
        const double expected = back_flux_without_mesh(4.0, medium, 1000000);
        const shapes::Mesh ball = shapes::sphere(4.0, 5);
        const double found = back_flux(ball, 4.0, ball.vertices.size(), medium);
        EXPECT_NEAR(found, expected, 0.02 * expected) << absorption;
    }
}

TEST(VolumeMonteCarlo, SurfacesInsideTheBodyAreNoWalls) {
    const TurbidMedium medium{.absorption = 0.1, .scattering = 0.9};
    const shapes::Mesh ball = shapes::sphere(4.0, 4);
    shapes::Mesh nested = ball;
    nested.append(shapes::sphere(3.7, 4));
    const double alone = back_flux(ball, 4.0, ball.vertices.size(), medium);
    EXPECT_NEAR(back_flux(nested, 4.0, ball.vertices.size(), medium), alone, 0.015 * alone);
}

TEST(VolumeMonteCarlo, ResultIsTheSameOnAnyNumberOfThreadsAndItsHalvesAreIndependent) {
    const shapes::Mesh ball = shapes::sphere(3.0, 3);
    std::vector<double> irradiance(ball.vertices.size(), 1.0);
    irradiance[0] = 5.0;
    const TurbidMedium medium{.absorption = 0.2, .scattering = 1.0};
    const auto run = [&](int threads, std::uint64_t seed) {
        return volume_monte_carlo(ball.vertices, ball.triangles, irradiance, medium,
                                  {.photons = 20000, .seed = seed, .threads = threads});
    };
    const Exitance one = run(1, 1);
    const Exitance three = run(3, 1);
    EXPECT_EQ(one.half[0], three.half[0]);
    EXPECT_EQ(one.half[1], three.half[1]);
    EXPECT_EQ(one.left, three.left);
    EXPECT_NE(one.half[0], one.half[1]);
    EXPECT_NE(one.half[0], run(1, 2).half[0]);
}

TEST(VolumeMonteCarlo, NoLightIsNoExitance) {
    const shapes::Mesh ball = shapes::sphere(3.0, 2);
    const Exitance exitance =
        volume_monte_carlo(ball.vertices, ball.triangles, std::vector<double>(ball.vertices.size(), 0.0), {});
    EXPECT_EQ(mean_exitance(exitance, ball.vertices.size()), 0.0);
}

TEST(VolumeMonteCarlo, LightThatLeavesThroughAHoleIsLostAndCounted) {
    shapes::Mesh ball = shapes::sphere(3.0, 3);
    ball.triangles.resize(ball.triangles.size() / 2);
    const std::vector<double> irradiance(ball.vertices.size(), 1.0);
    const Exitance exitance = volume_monte_carlo(ball.vertices, ball.triangles, irradiance,
                                                 {.absorption = 0.1, .scattering = 0.5}, {.photons = 20000});
    EXPECT_GT(exitance.lost + exitance.absorbed, 0.0);
    EXPECT_NEAR(exitance.left + exitance.absorbed + exitance.lost, exitance.entered, 0.02 * exitance.entered);
}

}  // namespace
}  // namespace skinglow::testing
