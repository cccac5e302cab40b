// Irradiance per vertex by kind of lamp, growth with vertices and lamps, and culling of ten thousand lamps:
// beside numpy in irradiance_against_numpy.py.
#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "rig/light_culling.h"
#include "rig/surface_irradiance.h"

namespace {

using namespace skinglow;

std::vector<Light> ring_of_lamps(LightKind kind, std::int64_t count, double distance, double power) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<Light> lights(static_cast<std::size_t>(count));
    for (Light& light : lights) {
        light.kind = kind;
        light.position =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))) * distance;
        light.direction = -light.position;
        light.power = power;
        light.size_x = 0.5;
        light.size_y = 0.3;
    }
    return lights;
}

/// A ball of 0.1, ring by ring.
std::vector<glm::dvec3> ball_normals(std::int64_t count) {
    const auto rings = static_cast<int>(std::sqrt(static_cast<double>(count) / 2));
    std::vector<glm::dvec3> normals;
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < 2 * rings; ++k) {
            const double theta = std::numbers::pi * (i + 0.5) / rings;
            const double phi = std::numbers::pi * k / rings;
            normals.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
        }
    }
    return normals;
}

void surface(benchmark::State& state, LightKind kind, AreaShape shape, double spread) {
    const std::vector<glm::dvec3> normals = ball_normals(state.range(0));
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& normal : normals) points.push_back(0.1 * normal);
    std::vector<Light> lights = ring_of_lamps(kind, state.range(1), 2.0, 10.0);
    for (Light& light : lights) {
        light.area_shape = shape;
        light.spread = spread;
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface_irradiance(lights, points, normals, {.threads = 1}));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size() * lights.size()));
}
constexpr double pi = std::numbers::pi;
BENCHMARK_CAPTURE(surface, point, LightKind::point, AreaShape::rectangle, pi)
    ->Args({1000, 16})
    ->Args({10000, 16})
    ->Args({100000, 16})
    ->Args({100000, 4})
    ->Args({100000, 64});
BENCHMARK_CAPTURE(surface, spot, LightKind::spot, AreaShape::rectangle, pi)->Args({100000, 16});
BENCHMARK_CAPTURE(surface, sun, LightKind::sun, AreaShape::rectangle, pi)->Args({100000, 16});
BENCHMARK_CAPTURE(surface, rectangle, LightKind::area, AreaShape::rectangle, pi)->Args({100000, 16});
BENCHMARK_CAPTURE(surface, ellipse, LightKind::area, AreaShape::ellipse, pi)->Args({1000, 16});
BENCHMARK_CAPTURE(surface, rectangle_with_spread, LightKind::area, AreaShape::rectangle, 2.0)
    ->Args({1000, 16});
BENCHMARK_CAPTURE(surface, ellipse_with_spread, LightKind::area, AreaShape::ellipse, 2.0)->Args({1000, 16});

void cull(benchmark::State& state) {
    std::vector<Light> lights = ring_of_lamps(LightKind::point, state.range(0) - 100, 100.0,
                                              1000.0 / static_cast<double>(state.range(0)));
    for (const Light& light : ring_of_lamps(LightKind::point, 100, 2.0, 100.0)) lights.push_back(light);
    const LightTree tree(lights);
    const Box box{glm::dvec3(-0.1), glm::dvec3(0.1)};
    std::size_t kept = 0;
    for (auto _ : state) kept = tree.cull(box, 0.05).kept.size();
    state.counters["kept"] = static_cast<double>(kept);
}
BENCHMARK(cull)->Arg(1000)->Arg(10000)->Arg(100000);

void build_tree(benchmark::State& state) {
    const std::vector<Light> lights = ring_of_lamps(LightKind::point, state.range(0), 2.0, 1.0);
    for (auto _ : state) benchmark::DoNotOptimize(LightTree(lights));
}
BENCHMARK(build_tree)->Arg(10000);

}  // namespace
