#pragma once

#include <skinglow/slab.h>

#include <cstddef>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

class StreamGrid;

/// A layer between two reflectors, on the modes that still carry light through it. With a the modal coefficients of
/// the sum of downward and upward light (layer_modes.h), the equations at the top and the bottom face are
///   (C + load_above) a_top - H a_bottom = source,   (C + load_below) a_bottom - H a_top = 0,
/// C = diag(k coth(k d)), H = diag(k / sinh(k d)), d the thickness, and T = receiver . a_bottom.
struct ModeProblem {
    std::vector<double> decay;       ///< k, 1/mm, above 0
    std::vector<double> load_above;  ///< lower triangle by rows: entry (i, j) at i (i + 1) / 2 + j
    std::vector<double> load_below;  ///< empty: the same as load_above, which halves the problem
    std::vector<double> source;      ///< per mode
    std::vector<double> receiver;    ///< per mode
};

/// The layer whose thickness varies, and what its two neighbors do to its modes.
///
/// A neighbor that reflects R turns t into -H s with H = (1 - R)(1 + R)^-1; in modes, b = source -
/// load_above a at the top and b = load_below a at the bottom. A mode that no longer carries light through the
/// layer has a fixed part in this, so that it can be eliminated beforehand: problem number i has the modes
/// from first_mode[i] on.
class VariableLayer {
  public:
    /// @param grid made for these layers (their indices alone count)
    /// @param layers of which the variable one's thickness is not read
    VariableLayer(const StreamGrid& grid, std::span<const Layer> layers, std::size_t variable);

    /// T of each thickness, one or more to a vector register of the processor (thickness_kernel.cpp); 0 where
    /// it is below 1e-300. Throws as flux_fraction does.
    /// @param thickness_mm finite, 0 or more (not checked)
    /// @param out of the same size
    void transmittance(std::span<const double> thickness_mm, std::span<double> out) const;

    /// The smallest problem that holds every mode that matters at this thickness and above.
    const ModeProblem& problem_for(double thickness_mm) const;

    double attenuation() const { return attenuation_; }  ///< absorption + scattering, 1/mm
    double slowest_decay() const { return decay_.back(); }
    std::size_t modes() const { return decay_.size(); }

  private:
    std::vector<double> decay_;  // k, 1/mm, descending
    double attenuation_ = 0;
    int streams_ = 0;
    std::vector<std::size_t> first_mode_;
    std::vector<ModeProblem> problems_;
};

}  // namespace skinglow::detail
