#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "../core/mesh_shapes.h"
#include "geometry/vector.h"
#include "geometry/welded_mesh.h"
#include "rays/cone_sampling.h"
#include "rays/thickness.h"

/// What a thickness costs, against the least one could do (a single ray along the axis, by the same Embree)
/// and against the same rays without an acceleration structure. The shell is about as fine as a head (13,000
/// vertices).
namespace {

using skinglow::shapes::Mesh;

const Mesh& head_sized() {
    static const Mesh mesh = [] {
        Mesh both = skinglow::shapes::shell(1.0, 0.1, 5);
        both.append(skinglow::shapes::sphere(0.3, 5));
        return both;
    }();
    return mesh;
}

void run(benchmark::State& state, const Mesh& mesh, const skinglow::ThicknessOptions& options) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(skinglow::thickness(mesh.vertices, mesh.triangles, options));
    }
    state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
    state.counters["vertices/s"] = benchmark::Counter(static_cast<double>(mesh.vertices.size()),
                                                      benchmark::Counter::kIsIterationInvariantRate);
}

void head_sized_rays(benchmark::State& state) {
    run(state, head_sized(), {.rays = static_cast<int>(state.range(0)), .threads = 1});
}
BENCHMARK(head_sized_rays)
    ->Name("head_sized/rays")
    ->Arg(1)
    ->Arg(16)
    ->Arg(64)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond);

void head_sized_all_threads(benchmark::State& state) {
    run(state, head_sized(), {});
}
BENCHMARK(head_sized_all_threads)
    ->Name("head_sized/default_rays_all_threads")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void head_sized_openness(benchmark::State& state) {
    run(state, head_sized(), {.min_openness = 0.1, .threads = 1});
}
BENCHMARK(head_sized_openness)->Name("head_sized/default_rays_min_openness")->Unit(benchmark::kMillisecond);

void small_embree(benchmark::State& state) {
    run(state, skinglow::shapes::sphere(1.0, 3), {.rays = 64, .threads = 1});
}
BENCHMARK(small_embree)->Name("small/embree_64_rays")->Unit(benchmark::kMillisecond);

/// Distance along a ray to a triangle's plane, if it meets the triangle (each edge seen from the same side).
std::optional<double> meet(const skinglow::WeldedMesh& mesh, const skinglow::WeldedTriangle& t,
                           const glm::dvec3& origin, const glm::dvec3& direction) {
    const double along = glm::dot(direction, t.unit_normal);
    if (along <= 0) return std::nullopt;
    const double distance = (t.plane - glm::dot(t.unit_normal, origin)) / along;
    if (distance <= 1e-6) return std::nullopt;
    const glm::dvec3 q = origin + distance * direction;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3& a = mesh.positions()[t.corners[k]];
        const glm::dvec3& b = mesh.positions()[t.corners[(k + 1) % 3]];
        if (glm::dot(glm::cross(b - a, q - a), t.unit_normal) < 0) return std::nullopt;
    }
    return distance;
}

void small_brute_force(benchmark::State& state) {
    const Mesh mesh = skinglow::shapes::sphere(1.0, 3);
    for (auto _ : state) {
        const skinglow::WeldedMesh welded(mesh.vertices, mesh.triangles);
        const auto directions = skinglow::cone_directions(64, skinglow::ThicknessOptions{}.cone_half_angle);
        for (std::uint32_t i = 0; i < welded.positions().size(); ++i) {
            const glm::dmat3 frame = skinglow::detail::frame_around(-welded.vertex_normal(i));
            for (const glm::dvec3& local : directions) {
                double nearest = std::numeric_limits<double>::infinity();
                const glm::dvec3 direction = frame * local;
                for (const auto& t : welded.triangles()) {
                    nearest = std::min(nearest,
                                       meet(welded, t, welded.positions()[i], direction).value_or(nearest));
                }
                benchmark::DoNotOptimize(nearest);
            }
        }
    }
    state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
    state.counters["vertices/s"] = benchmark::Counter(static_cast<double>(mesh.vertices.size()),
                                                      benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(small_brute_force)->Name("small/brute_force_64_rays")->Unit(benchmark::kMillisecond);

}  // namespace
