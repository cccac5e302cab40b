#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slab/slab_solver.h"
#include "slab/thickness_kernel.h"

namespace skinglow::slab {

/// The layer whose thickness varies, and what its two neighbors do to its modes.
///
/// A neighbor that reflects R turns t into -H s with H = (1 - R)(1 + R)^-1; in modes, b = source -
/// load_above a at the top and b = load_below a at the bottom. A mode that no longer reaches through the
/// layer has a fixed part in this, so that it can be eliminated beforehand: problem number i has the modes
/// from first_mode[i] on.
struct VariableLayer {
    std::vector<double> decay;  ///< k, 1/mm, descending
    double attenuation = 0;     ///< absorption + scattering, 1/mm
    std::vector<std::size_t> first_mode;
    std::vector<ModeProblem> problems;

    /// Arguments as for ThicknessCurve, already checked.
    VariableLayer(std::span<const Layer> layers, std::size_t variable, Incidence incidence, double n_above,
                  double n_below, int streams);

    /// The smallest problem that holds every mode that matters at this thickness and above.
    const ModeProblem& problem_for(double thickness) const;
};

}  // namespace skinglow::slab
