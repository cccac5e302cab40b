#include <benchmark/benchmark.h>
#include <skinglow/occlusion.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "../core/flat_light.h"
#include "../core/mesh_shapes.h"
#include "bare_embree.h"

/// Shadow rays a second, against Embree alone, and growth with triangles, lights and threads. The scene is a
/// ball between points on a floor and a light above: some rays meet it.
namespace {

using namespace skinglow;

const glm::dvec3 up(0, 0, 1);

std::vector<glm::dvec3> points(int count) {
    std::vector<glm::dvec3> found;
    for (int i = 0; i < count; ++i)
        found.emplace_back(-3.0 + 6.0 * (i + 0.5) / count, std::fmod(i * 0.618, 1.0) * 6.0 - 3.0, -2.0);
    return found;
}

FlatLight light(double radius) {
    FlatLight found;
    found.position = {0, 0, 4};
    found.radius = radius;
    return found;
}

void traced(benchmark::State& state, int levels, int lights, double radius, int threads) {
    const shapes::Mesh ball = shapes::sphere(1.0, levels);
    const MeshView view = ball.view();
    const Occluders occluders({&view, 1});
    const std::vector<Light> rig(static_cast<std::size_t>(lights), light(radius));
    const auto from = points(256);
    const std::vector<glm::dvec3> normals(from.size(), up);
    VisibilityOptions options;
    options.threads = threads;
    for (auto _ : state) benchmark::DoNotOptimize(visible_fraction(occluders, rig, from, normals, options));
    const double rays = 256.0 * lights * (radius > 0 ? options.samples : 1);
    state.counters["triangles"] = static_cast<double>(occluders.triangles());
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
}

void small_light(benchmark::State& state) {
    traced(state, static_cast<int>(state.range(0)), 1, 0.0, 1);
}
BENCHMARK(small_light)->Name("small_light/levels")->Arg(3)->Arg(5)->Arg(7);

void soft_light(benchmark::State& state) {
    traced(state, 5, static_cast<int>(state.range(0)), 0.5, 1);
}
BENCHMARK(soft_light)->Name("soft_light/lights")->Arg(1)->Arg(16);

void soft_light_all_threads(benchmark::State& state) {
    traced(state, 5, 16, 0.5, 0);
}
BENCHMARK(soft_light_all_threads)->Name("soft_light/16_lights_all_threads")->UseRealTime();

/// rtcOccluded1 for the rays of small_light, and nothing besides.
void bare_embree(benchmark::State& state) {
    const shapes::Mesh ball = shapes::sphere(1.0, static_cast<int>(state.range(0)));
    const benchmarks::BareEmbree scene(ball.vertices, ball.triangles);
    const auto from = points(256);
    const glm::dvec3 to = light(0.0).position;
    for (auto _ : state) {
        for (const glm::dvec3& point : from)
            benchmark::DoNotOptimize(scene.occluded(point, glm::normalize(to - point)));
    }
    state.counters["triangles"] = static_cast<double>(ball.triangles.size());
    state.counters["rays/s"] = benchmark::Counter(256.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(bare_embree)->Name("small_light/bare_rtcOccluded1/levels")->Arg(3)->Arg(5)->Arg(7);

void building(benchmark::State& state) {
    const shapes::Mesh ball = shapes::sphere(1.0, static_cast<int>(state.range(0)));
    const MeshView view = ball.view();
    for (auto _ : state) {
        const Occluders occluders({&view, 1});
        benchmark::DoNotOptimize(occluders.triangles());
    }
    state.counters["triangles"] = static_cast<double>(ball.triangles.size());
}
BENCHMARK(building)->Name("building/levels")->Arg(5)->Arg(7)->Unit(benchmark::kMillisecond);

}  // namespace
