#include "slab/slab_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "slab/layer_stack.h"
#include "slab/slab_arguments.h"
#include "slab/stream_grid.h"
#include "slab/unscattered.h"

namespace skinglow {

SlabResult solve_slab(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                      int streams) {
    slab::check_arguments(layers, incidence, n_above, n_below, streams);
    const auto grid = slab::stream_grid(layers, incidence, n_above, n_below, streams);
    SlabResult result;
    result.reflectance = grid->reflected_outright();
    result.absorbed.assign(layers.size(), 0);
    if (grid->incident().isZero(0)) return result;

    const slab::LayerStack stack(*grid, n_above, layers, n_below);
    const auto flux = [&](const Eigen::VectorXd& amplitudes) {
        return std::clamp(grid->root_flux_weight().head(amplitudes.size()).dot(amplitudes), 0.0, 1.0);
    };
    result.reflectance += flux(stack.reflection() * grid->incident());
    result.reflectance = std::min(1.0, result.reflectance);
    result.transmittance = flux(stack.transmit(grid->incident()));
    result.absorbed = stack.absorbed(grid->incident());
    result.unscattered =
        std::min(slab::unscattered_transmittance(*grid, layers, n_above, n_below), result.transmittance);
    return result;
}

DirectionalTransmittance directional_transmittance(std::span<const Layer> layers, double n_above,
                                                   double n_below, int streams) {
    // Normal incidence gives the grid a stream at cosine 1.
    slab::check_arguments(layers, Incidence::normal(), n_above, n_below, streams);
    const auto grid = slab::stream_grid(layers, Incidence::normal(), n_above, n_below, streams);
    const slab::LayerStack stack(*grid, n_above, layers, n_below);
    const Eigen::VectorXd& root = grid->root_flux_weight();
    const Eigen::VectorXd leaving = stack.transmit_transposed(root.head(grid->count(n_below)));
    DirectionalTransmittance result;
    for (int i = 0; i < grid->count(n_above); ++i) {
        const double mu = grid->cosine(i, n_above);
        result.mu.push_back(mu);
        result.weight.push_back(root[i] * root[i] / (mu * n_above * n_above));
        result.transmittance.push_back(std::clamp(leaving[i] / root[i], 0.0, 1.0));
    }
    return result;
}

}  // namespace skinglow
