#include <skinglow/slab.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "slab/layer_stack.h"
#include "slab/stream_grid.h"

namespace skinglow {
namespace {

// Of a stream's flux above the stack, the fraction that leaves below without having been scattered, through
// every layer and every specular reflection between boundaries.
double unscattered_fraction(const StreamGrid& grid, int stream, std::span<const Layer> layers, double n_above,
                            double n_below) {
    // From the bottom up: what all below reflects upwards and transmits downwards.
    double reflected = grid.reflectance(stream, layers.back().refractive_index, n_below);
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
        const double r = grid.reflectance(stream, i == 0 ? n_above : layers[i - 1].refractive_index,
                                          layer.refractive_index);
        const double between = 1 - r * reflected;
        if (between <= 0) return 0;  // trapped by total reflection at both boundaries
        passed *= (1 - r) / between;
        reflected = r + (1 - r) * (1 - r) * reflected / between;
    }
    return passed;
}

}  // namespace

SlabResult slab(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                int streams) {
    const StreamGrid grid(layers, incidence, n_above, n_below, streams);
    SlabResult result;
    result.reflectance = grid.reflected_outright();
    result.absorbed.assign(layers.size(), 0);
    const Eigen::VectorXd& incident = grid.incident();
    if (incident.isZero(0)) return result;

    const LayerStack stack(grid, n_above, layers, n_below);
    const auto flux = [&](const Eigen::VectorXd& amplitudes) {
        return grid.root_flux_weight().head(amplitudes.size()).dot(amplitudes);
    };
    result.reflectance =
        flux_fraction("reflectance", result.reflectance + flux(stack.reflection() * incident), streams);
    result.transmittance = flux_fraction("transmittance", flux(stack.transmit(incident)), streams);
    result.absorbed = stack.absorbed(incident);
    for (double& absorbed : result.absorbed) absorbed = flux_fraction("absorbed", absorbed, streams);
    for (int stream = 0; stream < incident.size(); ++stream) {
        const double flux_in = incident[stream] * grid.root_flux_weight()[stream];
        if (flux_in > 0) {
            result.unscattered += flux_in * unscattered_fraction(grid, stream, layers, n_above, n_below);
        }
    }
    result.unscattered = std::min(result.unscattered, result.transmittance);
    return result;
}

DirectionalTransmittance directional_transmittance(std::span<const Layer> layers, double n_above,
                                                   double n_below, int streams) {
    // Normal incidence gives the grid a stream at cosine 1.
    const StreamGrid grid(layers, Incidence::normal(), n_above, n_below, streams);
    const LayerStack stack(grid, n_above, layers, n_below);
    const Eigen::VectorXd& root = grid.root_flux_weight();
    const Eigen::VectorXd leaving = stack.transmit_transposed(root.head(grid.count(n_below)));
    DirectionalTransmittance result;
    for (int i = 0; i < grid.count(n_above); ++i) {
        const double mu = grid.cosine(i, n_above);
        result.mu.push_back(mu);
        result.weight.push_back(root[i] * root[i] / (mu * n_above * n_above));
        result.transmittance.push_back(flux_fraction("transmittance", leaving[i] / root[i], streams));
    }
    return result;
}

}  // namespace skinglow
