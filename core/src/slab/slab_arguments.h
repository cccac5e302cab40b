#pragma once

#include <cstddef>
#include <span>

#include "slab/slab_solver.h"

namespace skinglow::slab {

/// Throws std::invalid_argument that names the layer, the field, its value and what is allowed.
void check_arguments(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                     int streams);

}  // namespace skinglow::slab
