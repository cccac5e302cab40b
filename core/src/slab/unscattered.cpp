#include "slab/unscattered.h"

#include <cmath>
#include <cstddef>

#include "slab/fresnel.h"

namespace skinglow::slab {
namespace {

// Flux from above one stream to below the stack; 0 where a boundary reflects it totally.
double passed_by(const StreamGrid& grid, int stream, std::span<const Layer> layers, double n_above,
                 double n_below) {
    const auto reflectance = [&](double n_a, double n_b) {
        if (n_a == n_b) return 0.0;
        if (stream >= grid.count(n_a) || stream >= grid.count(n_b)) return 1.0;
        return fresnel_reflectance(n_a, grid.cosine(stream, n_a), n_b, grid.cosine(stream, n_b));
    };
    // From the bottom up: what all below reflects upwards and lets through downwards.
    double reflected = reflectance(layers.back().refractive_index, n_below);
    double passed = 1 - reflected;
    for (std::size_t i = layers.size(); i-- > 0;) {
        const Layer& layer = layers[i];
        if (stream >= grid.count(layer.refractive_index)) return 0;
        const double attenuation = layer.absorption + layer.scattering;
        if (attenuation > 0) {
            const double through =
                std::exp(-attenuation * layer.thickness / grid.cosine(stream, layer.refractive_index));
            reflected *= through * through;
            passed *= through;
        }
        const double r =
            reflectance(i == 0 ? n_above : layers[i - 1].refractive_index, layer.refractive_index);
        const double between = 1 - r * reflected;
        if (between <= 0) return 0;  // shut in on both sides
        passed *= (1 - r) / between;
        reflected = r + (1 - r) * (1 - r) * reflected / between;
    }
    return passed;
}

}  // namespace

double unscattered_transmittance(const StreamGrid& grid, std::span<const Layer> layers, double n_above,
                                 double n_below) {
    double flux = 0;
    for (int stream = 0; stream < grid.incident().size(); ++stream) {
        const double incident = grid.incident()[stream] * grid.root_flux_weight()[stream];
        if (incident > 0) flux += incident * passed_by(grid, stream, layers, n_above, n_below);
    }
    return flux;
}

}  // namespace skinglow::slab
