#pragma once

#include <Eigen/Core>

#include "slab/layer_modes.h"
#include "slab/stream_grid.h"

namespace skinglow::detail {

/// k tanh(k d / 2), k coth(k d / 2) and k / sinh(k d) of every mode, safe for k = 0, and for k d from 1e-300
/// to infinity: only decaying exponentials appear.
struct ModeFactors {
    Eigen::VectorXd symmetric;
    Eigen::VectorXd antisymmetric;
    Eigen::VectorXd through;
};
ModeFactors mode_factors(const Eigen::VectorXd& decay, double thickness);

/// Reflection and transmission of a layer alone, from either side, without its boundaries. Streams x streams.
struct LayerOperators {
    Eigen::MatrixXd reflection;
    Eigen::MatrixXd transmission;
};
/// @param thickness mm, above 0; may be infinite.
LayerOperators layer_operators(const LayerModes& modes, double thickness);

/// What happens at a boundary with something below that reflects.
struct Crossing {
    Eigen::MatrixXd reflection;    ///< seen from above the boundary
    Eigen::MatrixXd transmission;  ///< downward amplitudes just below, from downward ones just above
};
/// @param reflection_below of what lies below, streams of n_to squared; empty: nothing reflects.
Crossing cross_boundary(const StreamGrid& grid, double n_from, double n_to,
                        const Eigen::MatrixXd& reflection_below);

/// The same for a layer: `reflection_below` is that of all below its lower face.
Crossing cross_layer(const LayerOperators& layer, const Eigen::MatrixXd& reflection_below);

}  // namespace skinglow::detail
