// The spectrum of skin over thickness: 30 wavelengths x 256 thicknesses x one incidence, on one thread, and
// beside each time the error it bought: the largest relative one where T > 1e-6, against 96 streams.
#include <benchmark/benchmark.h>
#include <skinglow/slab.h>
#include <skinglow/tissue.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace {

using skinglow::Incidence;
using skinglow::Layer;

constexpr double least_wavelength_nm = 400;
constexpr double most_wavelength_nm = 700;
constexpr double largest_thickness_mm = 12;

std::vector<double> evenly(double from, double to, std::int64_t count) {
    std::vector<double> values;
    for (std::int64_t i = 0; i < count; ++i) {
        values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
    }
    return values;
}

// 1 layer: dermis alone; 2: with an epidermis on one side; 3: on both.
std::vector<std::vector<Layer>> skin(std::int64_t layers, std::int64_t wavelengths) {
    std::vector<std::vector<Layer>> stacks;
    for (const double nm : evenly(least_wavelength_nm, most_wavelength_nm, wavelengths)) {
        const skinglow::Tissue tissue;
        const skinglow::SkinMedia media = skinglow::skin_media(tissue, nm);
        Layer epidermis = media.epidermis;
        epidermis.thickness = tissue.epidermal_thickness_mm;
        std::vector<Layer> stack{media.inner};
        if (layers > 1) stack.insert(stack.begin(), epidermis);
        if (layers > 2) stack.push_back(epidermis);
        stacks.push_back(stack);
    }
    return stacks;
}

void solve(const std::vector<std::vector<Layer>>& stacks, Incidence incidence, int streams,
           const std::vector<double>& thickness, std::vector<double>& out) {
    for (std::size_t i = 0; i < stacks.size(); ++i) {
        const skinglow::ThicknessCurve curve(stacks[i], stacks[i].size() > 1 ? 1 : 0, incidence, 1, 1,
                                             streams);
        curve.transmittance(thickness, std::span(out).subspan(i * thickness.size(), thickness.size()));
    }
}

double largest_error(const std::vector<double>& found, const std::vector<double>& reference) {
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (reference[i] > 1e-6) largest = std::max(largest, std::abs(found[i] / reference[i] - 1));
    }
    return largest;
}

void skin_curves(benchmark::State& state, std::int64_t layers, Incidence incidence) {
    const auto streams = static_cast<int>(state.range(0));
    const auto stacks = skin(layers, 30);
    const auto thickness = evenly(0, largest_thickness_mm, 256);
    std::vector<double> out(stacks.size() * thickness.size());
    for (auto _ : state) {
        solve(stacks, incidence, streams, thickness, out);
        benchmark::ClobberMemory();
    }
    std::vector<double> reference(out.size());
    solve(stacks, incidence, 96, thickness, reference);
    state.counters["largest_error"] = largest_error(out, reference);
}
#define STREAMS \
    Unit(benchmark::kMillisecond)->Arg(4)->Arg(6)->Arg(8)->Arg(10)->Arg(12)->Arg(16)->Arg(24)->Arg(32)
BENCHMARK_CAPTURE(skin_curves, one_layer_diffuse, 1, Incidence::diffuse())->STREAMS;
BENCHMARK_CAPTURE(skin_curves, one_layer_normal, 1, Incidence::normal())->STREAMS;
BENCHMARK_CAPTURE(skin_curves, three_layers_diffuse, 3, Incidence::diffuse())->STREAMS;
BENCHMARK_CAPTURE(skin_curves, three_layers_normal, 3, Incidence::normal())->STREAMS;
BENCHMARK_CAPTURE(skin_curves, two_layers_diffuse, 2, Incidence::diffuse())->STREAMS;

// The cost against the number of thicknesses and of wavelengths: both fits should say N.
void by_thicknesses(benchmark::State& state) {
    const auto stacks = skin(1, 30);
    const auto thickness = evenly(0, largest_thickness_mm, state.range(0));
    std::vector<double> out(stacks.size() * thickness.size());
    for (auto _ : state) {
        solve(stacks, Incidence::diffuse(), 8, thickness, out);
        benchmark::ClobberMemory();
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(by_thicknesses)->RangeMultiplier(4)->Range(64, 65536)->Unit(benchmark::kMillisecond)->Complexity();

void by_wavelengths(benchmark::State& state) {
    const auto stacks = skin(3, state.range(0));
    const auto thickness = evenly(0, largest_thickness_mm, 256);
    std::vector<double> out(stacks.size() * thickness.size());
    for (auto _ : state) {
        solve(stacks, Incidence::diffuse(), 8, thickness, out);
        benchmark::ClobberMemory();
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(by_wavelengths)->RangeMultiplier(4)->Range(8, 2048)->Unit(benchmark::kMillisecond)->Complexity();

// One slab, once: the figure other solvers quote.
void single_slab(benchmark::State& state) {
    const Layer layer{1.4, .1, 10, .8, 1};
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            skinglow::slab({&layer, 1}, Incidence::diffuse(), 1, 1, static_cast<int>(state.range(0))));
    }
}
BENCHMARK(single_slab)->Arg(8)->Arg(16)->Arg(32)->Unit(benchmark::kMicrosecond);

}  // namespace
