// Irradiance per vertex by kind of light, growth with vertices and lights, and culling of ten thousand lights:
// beside numpy in irradiance_against_numpy.py.
#include <benchmark/benchmark.h>
#include <skinglow/rig.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace skinglow;

LightShape area(AreaShape shape, double spread) {
    return AreaLight{.area_shape = shape, .size_x = 0.5, .size_y = 0.3, .spread = spread};
}

std::vector<Light> ring_of_lights(const LightShape& shape, std::int64_t count, double distance,
                                  double power) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<Light> lights;
    for (std::int64_t i = 0; i < count; ++i) {
        const glm::dvec3 position =
            glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))) * distance;
        lights.emplace_back(
            LightSettings{.shape = shape, .position = position, .direction = -position, .power = power});
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

void surface(benchmark::State& state, const LightShape& shape) {
    const std::vector<glm::dvec3> normals = ball_normals(state.range(0));
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& normal : normals) points.push_back(0.1 * normal);
    const std::vector<Light> lights = ring_of_lights(shape, state.range(1), 2.0, 10.0);
    for (auto _ : state) {
        benchmark::DoNotOptimize(surface_irradiance(lights, points, normals, {.threads = 1}));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size() * lights.size()));
}
constexpr double pi = std::numbers::pi;
BENCHMARK_CAPTURE(surface, point, PointLight{})
    ->Args({1000, 16})
    ->Args({10000, 16})
    ->Args({100000, 16})
    ->Args({100000, 4})
    ->Args({100000, 64});
BENCHMARK_CAPTURE(surface, spot, SpotLight{})->Args({100000, 16});
BENCHMARK_CAPTURE(surface, sun, SunLight{})->Args({100000, 16});
BENCHMARK_CAPTURE(surface, rectangle, area(AreaShape::rectangle, pi))->Args({100000, 16});
BENCHMARK_CAPTURE(surface, ellipse, area(AreaShape::ellipse, pi))->Args({1000, 16});
BENCHMARK_CAPTURE(surface, rectangle_with_spread, area(AreaShape::rectangle, 2.0))->Args({1000, 16});
BENCHMARK_CAPTURE(surface, ellipse_with_spread, area(AreaShape::ellipse, 2.0))->Args({1000, 16});

void cull(benchmark::State& state) {
    std::vector<Light> lights = ring_of_lights(PointLight{}, state.range(0) - 100, 100.0,
                                               1000.0 / static_cast<double>(state.range(0)));
    for (const Light& light : ring_of_lights(PointLight{}, 100, 2.0, 100.0)) lights.push_back(light);
    const PreparedRig rig(lights);
    const Box box{glm::dvec3(-0.1), glm::dvec3(0.1)};
    std::size_t kept = rig.cull(box, 0.05).kept.size();
    for (auto _ : state) kept = rig.cull(box, 0.05).kept.size();
    state.counters["kept"] = static_cast<double>(kept);
}
BENCHMARK(cull)->Arg(1000)->Arg(10000)->Arg(100000);

void prepare_and_build_tree(benchmark::State& state) {
    const std::vector<Light> lights = ring_of_lights(PointLight{}, state.range(0), 2.0, 1.0);
    for (auto _ : state) benchmark::DoNotOptimize(PreparedRig(lights).cull({}, 1e30));
}
BENCHMARK(prepare_and_build_tree)->Arg(10000);

}  // namespace
