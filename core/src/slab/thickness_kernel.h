#pragma once

#include <cstddef>
#include <vector>

namespace skinglow::slab {

/// Thicknesses solved side by side, one to a lane of the processor's vector registers.
constexpr std::size_t lanes = 8;

/// A layer between two reflectors, on the modes that still reach through it. With a the modal coefficients of
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

/// T of `lanes` thicknesses, mm, 0 or more; 0 where it is below 1e-300. The result is not yet held to [0, 1].
/// @param attenuation absorption + scattering of the layer, 1/mm.
/// @param scratch memory that solves share; grows to the largest problem.
void solve_lanes(const ModeProblem& problem, double attenuation, const double* thickness,
                 double* transmittance, std::vector<double>& scratch);

}  // namespace skinglow::slab
