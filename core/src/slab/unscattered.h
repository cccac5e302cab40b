#pragma once

#include <span>

#include "slab/stream_grid.h"

namespace skinglow::slab {

/// Flux that leaves below without having been scattered: each stream on its own, through every layer and
/// every mirror reflection between boundaries.
double unscattered_transmittance(const StreamGrid& grid, std::span<const Layer> layers, double n_above,
                                 double n_below);

}  // namespace skinglow::slab
