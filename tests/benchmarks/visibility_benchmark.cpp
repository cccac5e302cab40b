#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "../core/mesh_shapes.h"
#include "rays/visibility.h"

/// Shadow rays a second, against every triangle for every ray, and growth with triangles, lamps and threads.
/// The scene is a ball between places on a floor and a lamp above: some rays meet it.
namespace {

using namespace skinglow;

const glm::dvec3 up(0, 0, 1);

std::vector<glm::dvec3> places(int count) {
    std::vector<glm::dvec3> found;
    for (int i = 0; i < count; ++i)
        found.emplace_back(-3.0 + 6.0 * (i + 0.5) / count, std::fmod(i * 0.618, 1.0) * 6.0 - 3.0, -2.0);
    return found;
}

Light lamp(double radius) {
    Light light;
    light.position = {0, 0, 4};
    light.radius = radius;
    return light;
}

void traced(benchmark::State& state, int levels, int lamps, double radius, int threads) {
    const shapes::Mesh ball = shapes::sphere(1.0, levels);
    const MeshView view{ball.vertices, ball.triangles};
    const Occluders occluders({&view, 1});
    const std::vector<Light> lights(static_cast<std::size_t>(lamps), lamp(radius));
    const auto points = places(256);
    const std::vector<glm::dvec3> normals(points.size(), up);
    VisibilityOptions options;
    options.threads = threads;
    for (auto _ : state) benchmark::DoNotOptimize(visible_share(occluders, lights, points, normals, options));
    const double rays = 256.0 * lamps * (radius > 0 ? options.samples : 1);
    state.counters["triangles"] = static_cast<double>(occluders.triangles());
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
}

void small_lamp(benchmark::State& state) {
    traced(state, static_cast<int>(state.range(0)), 1, 0.0, 1);
}
BENCHMARK(small_lamp)->Name("small_lamp/levels")->Arg(3)->Arg(5)->Arg(7);

void soft_lamp(benchmark::State& state) {
    traced(state, 5, static_cast<int>(state.range(0)), 0.5, 1);
}
BENCHMARK(soft_lamp)->Name("soft_lamp/lamps")->Arg(1)->Arg(16);

void soft_lamp_all_threads(benchmark::State& state) {
    traced(state, 5, 16, 0.5, 0);
}
BENCHMARK(soft_lamp_all_threads)->Name("soft_lamp/16_lamps_all_threads")->UseRealTime();

/// T. Moeller and B. Trumbore's test ("Fast, minimum storage ray/triangle intersection", 1997).
bool meets(const shapes::Mesh& mesh, const glm::uvec3& t, const glm::dvec3& from, const glm::dvec3& way) {
    const glm::dvec3& a = mesh.vertices[t.x];
    const glm::dvec3 e1 = mesh.vertices[t.y] - a;
    const glm::dvec3 e2 = mesh.vertices[t.z] - a;
    const glm::dvec3 p = glm::cross(way, e2);
    const double inverse = 1.0 / glm::dot(e1, p);
    const glm::dvec3 s = from - a;
    const double u = glm::dot(s, p) * inverse;
    if (!(u > 0.0 && u < 1.0)) return false;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(way, q) * inverse;
    const double w = glm::dot(e2, q) * inverse;
    return v > 0.0 && u + v < 1.0 && w > 0.0 && w < 1.0;
}

void every_triangle(benchmark::State& state) {
    const shapes::Mesh ball = shapes::sphere(1.0, static_cast<int>(state.range(0)));
    const auto points = places(256);
    const glm::dvec3 light = lamp(0.0).position;
    for (auto _ : state) {
        for (const glm::dvec3& point : points) {
            bool hit = false;
            for (std::size_t i = 0; i < ball.triangles.size() && !hit; ++i)
                hit = meets(ball, ball.triangles[i], point, light - point);
            benchmark::DoNotOptimize(hit);
        }
    }
    state.counters["triangles"] = static_cast<double>(ball.triangles.size());
    state.counters["rays/s"] = benchmark::Counter(256.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(every_triangle)->Name("small_lamp/every_triangle/levels")->Arg(3)->Arg(5);

void building(benchmark::State& state) {
    const shapes::Mesh ball = shapes::sphere(1.0, static_cast<int>(state.range(0)));
    const MeshView view{ball.vertices, ball.triangles};
    for (auto _ : state) {
        const Occluders occluders({&view, 1});
        benchmark::DoNotOptimize(occluders.triangles());
    }
    state.counters["triangles"] = static_cast<double>(ball.triangles.size());
}
BENCHMARK(building)->Name("building/levels")->Arg(5)->Arg(7)->Unit(benchmark::kMillisecond);

}  // namespace
