// Recoloring a table, beside copying the bytes it writes: a lower bound for any way of filling the table.
#include <benchmark/benchmark.h>
#include <skinglow/lut.h>

#include <cstring>
#include <vector>

namespace {

void recolor_table(benchmark::State& state) {
    const auto size = static_cast<std::size_t>(state.range(0));
    const skinglow::BaseLut base = skinglow::six_gaussian_base({size, 12.0});
    std::vector<glm::dvec3> out(size);
    glm::dvec3 weight(1.8, 0.5, 0.4);
    for (auto _ : state) {
        benchmark::DoNotOptimize(weight);
        skinglow::recolor(base, weight, out);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(recolor_table)->Arg(256)->Arg(65536);

void copy_same_bytes(benchmark::State& state) {
    const auto size = static_cast<std::size_t>(state.range(0));
    const std::vector<glm::dvec3> from(size, glm::dvec3(0.5));
    std::vector<glm::dvec3> out(size);
    for (auto _ : state) {
        std::memcpy(out.data(), from.data(), size * sizeof(glm::dvec3));
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(copy_same_bytes)->Arg(256)->Arg(65536);

}  // namespace
