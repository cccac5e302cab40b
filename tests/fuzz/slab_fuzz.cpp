// Slabs of any layers: R + T + A = 1, each from 0 to 1, or a refusal.

#include <skinglow/slab.h>

#include <numeric>
#include <vector>

#include "fuzz_input.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    const int streams = static_cast<int>(4 + 2 * input.below(7));
    const double mu0 = input.near_range(0.0, 1.0);
    const auto kind = static_cast<Incidence::Kind>(input.below(3));
    const Incidence incidence =
        kind == Incidence::Kind::oblique ? Incidence::oblique(mu0) : Incidence{kind, 1.0};
    const double n_above = input.flag() ? 1.0 : input.near_range(1.0, 3.0);
    const double n_below = input.flag() ? 1.0 : input.near_range(1.0, 3.0);
    std::vector<Layer> layers(1 + input.below(3));
    for (Layer& layer : layers) {
        layer.refractive_index = input.flag() ? 1.4 : input.near_range(1.0, 3.0);
        layer.absorption = input.near_decades(1e-12, 1e6);
        layer.scattering = input.near_decades(1e-12, 1e6);
        layer.anisotropy = input.near_range(-0.99, 0.99);
        layer.thickness = input.near_decades(1e-9, 1e6);
    }
    runs([&] {
        const SlabResult result = slab(layers, incidence, n_above, n_below, streams);
        const auto is_fraction = [](double x) { return x >= 0 && x <= 1; };
        require(is_fraction(result.reflectance) && is_fraction(result.transmittance) &&
                    is_fraction(result.unscattered),
                "R, T and what is not scattered are fractions");
        for (const double absorbed : result.absorbed) require(is_fraction(absorbed), "A is a fraction");
        const double absorbed = std::accumulate(result.absorbed.begin(), result.absorbed.end(), 0.0);
        require(std::abs(result.reflectance + result.transmittance + absorbed - 1) < 1e-8, "R + T + A = 1");
        require(result.unscattered <= result.transmittance * (1 + 1e-9),
                "what is not scattered is a part of T");
    });
    return 0;
}
