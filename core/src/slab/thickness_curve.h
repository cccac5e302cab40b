#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "slab/slab_solver.h"

namespace skinglow {

/// Transmittance of a stack of layers in which one layer takes any thickness and the others keep theirs. The
/// transport problem of each layer is solved once, on construction; a thickness then costs a small solve of
/// as many unknowns as modes still reach through the layer. Copies share what was solved; safe to use from
/// many threads at once.
class ThicknessCurve {
  public:
    /// @param layers, incidence, n_above, n_below, streams as for solve_slab, with its errors. The thickness
    ///        given for the variable layer is not read.
    /// @param variable_layer index of that layer, below layers.size(). A half-space cannot be it, nor be in
    ///        the stack: nothing would come through.
    ThicknessCurve(std::span<const Layer> layers, std::size_t variable_layer, Incidence incidence,
                   double n_above = 1, double n_below = 1, int streams = 16);
    ~ThicknessCurve();
    ThicknessCurve(const ThicknessCurve&);
    ThicknessCurve(ThicknessCurve&&) noexcept;
    ThicknessCurve& operator=(const ThicknessCurve&);
    ThicknessCurve& operator=(ThicknessCurve&&) noexcept;

    /// Fraction of the incident flux that comes through, the unscattered part included; 0 where it is below
    /// 1e-300.
    /// @param inner_thickness_mm of the variable layer, finite, 0 or more; else std::invalid_argument.
    double transmittance(double inner_thickness_mm) const;

    /// The same for many thicknesses in any order (ascending is fastest), into `out` of the same size.
    void transmittance(std::span<const double> inner_thickness_mm, std::span<double> out) const;

    /// The rate at which log T falls in the end, 1/mm: the diffusion exponent of the variable layer.
    double decay_rate() const;

  private:
    class Solution;
    std::shared_ptr<const Solution> solution_;
};

}  // namespace skinglow
