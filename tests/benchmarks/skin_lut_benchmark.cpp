#include <benchmark/benchmark.h>
#include <skinglow/lut.h>
#include <skinglow/tissue.h>

#include <vector>

#include "skin/diffusion_approximation.h"

namespace {

using namespace skinglow;

std::vector<double> even(double first, double last, std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1);
    }
    return values;
}

Tissue light_skin(bool with_epidermis) {
    Tissue tissue;
    if (!with_epidermis) tissue.epidermal_thickness_mm = 0.0;
    return tissue;
}

/// 30 wavelengths x 256 thicknesses, lit diffusely. Arguments: streams, epidermis or not.
/// 8 streams leave 3e-4 (one layer), 10 leave 3e-4 (three layers) where T > 1e-6: docs/accuracy.md.
void skin_transmittance(benchmark::State& state) {
    const Tissue tissue = light_skin(state.range(1) != 0);
    const std::vector<double> thickness = even(0.0, 12.0, 256), nm = even(400.0, 700.0, 30);
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            transmittance(tissue, thickness, nm, Incidence::diffuse(), static_cast<int>(state.range(0))));
    }
}
BENCHMARK(skin_transmittance)
    ->ArgNames({"streams", "epidermis"})
    ->ArgsProduct({{8, 10, 16}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

/// Cost by the number of thicknesses (30 wavelengths) and of wavelengths (256 thicknesses): both linear.
void by_thicknesses(benchmark::State& state) {
    const std::vector<double> thickness = even(0.0, 12.0, static_cast<std::size_t>(state.range(0))),
                              nm = even(400.0, 700.0, 30);
    for (auto _ : state) {
        benchmark::DoNotOptimize(transmittance(light_skin(true), thickness, nm, Incidence::diffuse(), 10));
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(by_thicknesses)
    ->RangeMultiplier(4)
    ->Range(64, 4096)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);

void by_wavelengths(benchmark::State& state) {
    const std::vector<double> thickness = even(0.0, 12.0, 256),
                              nm = even(400.0, 700.0, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(transmittance(light_skin(true), thickness, nm, Incidence::diffuse(), 10));
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(by_wavelengths)
    ->RangeMultiplier(2)
    ->Range(8, 128)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);

/// The table of mode physical, 256 entries. Argument: tolerance is 10^-n.
void base_lut_at_tolerance(benchmark::State& state) {
    double tolerance = 1.0;
    for (auto n = state.range(0); n > 0; --n) tolerance *= 0.1;
    for (auto _ : state) benchmark::DoNotOptimize(base_lut(light_skin(true), 256, 12.0, tolerance));
}
BENCHMARK(base_lut_at_tolerance)->ArgName("n")->DenseRange(1, 5)->Unit(benchmark::kMillisecond);

/// The same with nothing left out, at the streams that tolerance 1e-3 takes and at more.
void full_table(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            reference_lut(light_skin(true), 256, 12.0, static_cast<int>(state.range(0))));
    }
}
BENCHMARK(full_table)->ArgName("streams")->Arg(10)->Arg(16)->Arg(32)->Unit(benchmark::kMillisecond);

/// Diffusion theory at the task of skin_transmittance.
void diffusion(benchmark::State& state) {
    const std::vector<double> thickness = even(0.0, 12.0, 256), nm = even(400.0, 700.0, 30);
    for (auto _ : state) benchmark::DoNotOptimize(diffusion_transmittance(light_skin(true), thickness, nm));
}
BENCHMARK(diffusion)->Unit(benchmark::kMillisecond);

}  // namespace
