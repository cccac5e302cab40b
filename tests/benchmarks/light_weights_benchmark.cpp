// Eq. 3 for 1, 100 and 10,000 lights, beside the same sum without compensation: the price of not minding the
// order.
#include <benchmark/benchmark.h>
#include <skinglow/light_weights.h>

#include <random>
#include <vector>

namespace {

std::vector<skinglow::Light> random_lights(std::int64_t count) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0.1, 10.0);
    const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
    std::vector<skinglow::Light> lights;
    for (std::int64_t i = 0; i < count; ++i)
        lights.emplace_back(skinglow::LightSettings{.color = vector(), .position = vector()});
    return lights;
}

void light_weight(benchmark::State& state) {
    const auto lights = random_lights(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(skinglow::light_weight(lights, glm::dvec3(0.0)));
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetComplexityN(state.range(0));
}
BENCHMARK(light_weight)->Arg(1)->Arg(100)->Arg(10000)->Complexity(benchmark::oN);

void plain_sum_unchecked(benchmark::State& state) {
    const auto lights = random_lights(state.range(0));
    for (auto _ : state) {
        glm::dvec3 sum(0.0);
        for (const skinglow::Light& light : lights) {
            const glm::dvec3 p = light.position();
            sum += light.color() / (1.0 + p.x * p.x + p.y * p.y + p.z * p.z);
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(plain_sum_unchecked)->Arg(1)->Arg(100)->Arg(10000);

}  // namespace
