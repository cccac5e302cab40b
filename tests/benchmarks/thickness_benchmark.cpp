#include <benchmark/benchmark.h>
#include <skinglow/thickness.h>

#include <vector>

#include "../core/mesh_shapes.h"
#include "bare_embree.h"
#include "geometry/vector.h"
#include "geometry/welded_mesh.h"
#include "rays/direction_sampling.h"

/// What a thickness costs, against the same rays by Embree alone. The shell is about as fine as a head
/// (13,000 vertices).
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

void count_vertices(benchmark::State& state, std::size_t count) {
    state.counters["vertices"] = static_cast<double>(count);
    state.counters["vertices/s"] =
        benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
}

void run(benchmark::State& state, const Mesh& mesh, const skinglow::ThicknessOptions& options) {
    for (auto _ : state) benchmark::DoNotOptimize(skinglow::thickness(mesh.view(), options));
    count_vertices(state, mesh.vertices.size());
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

void head_sized_sky(benchmark::State& state) {
    run(state, head_sized(), {.min_sky_visibility = 0.1, .threads = 1});
}
BENCHMARK(head_sized_sky)->Name("head_sized/default_rays_min_sky_visibility")->Unit(benchmark::kMillisecond);

/// The same rays from the same vertices by rtcIntersect1 alone, nearest hit only.
void head_sized_bare_embree(benchmark::State& state) {
    const skinglow::detail::WeldedMesh mesh(head_sized().view());
    std::vector<glm::uvec3> corners;
    for (const auto& t : mesh.triangles()) corners.push_back(t.corners);
    const skinglow::benchmarks::BareEmbree scene(mesh.positions(), corners);
    const auto directions = skinglow::detail::cone_directions(static_cast<int>(state.range(0)),
                                                              skinglow::ThicknessOptions{}.cone_half_angle);
    for (auto _ : state) {
        for (std::uint32_t i = 0; i < mesh.positions().size(); ++i) {
            const glm::dmat3 frame = skinglow::detail::frame_around(-mesh.normals()[i]);
            for (const glm::dvec3& local : directions)
                benchmark::DoNotOptimize(scene.nearest(mesh.positions()[i], frame * local));
        }
    }
    count_vertices(state, mesh.positions().size());
}
BENCHMARK(head_sized_bare_embree)
    ->Name("head_sized/bare_rtcIntersect1/rays")
    ->Arg(1)
    ->Arg(16)
    ->Arg(64)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond);

}  // namespace
