#pragma once

#include <skinglow/slab.h>

#include <Eigen/Core>

#include "slab/stream_grid.h"

namespace skinglow::detail {

/// The solutions of the transport equation inside one homogeneous layer, for any thickness of it.
///
/// With s and t the sum and the difference of the downward and upward amplitudes, s' = -S2 t and t' = -S1 s.
/// S1 = F F^T and S2 = G G^T are known as products: F = mu^-1/2 Q_even E^1/2, G = mu^-1/2 Q_odd O^1/2 with
/// E, O = absorption + scattering (1 - g^l), l even or odd. No albedo, and no 1 - albedo, is ever formed, so
/// that nothing is lost when absorption is 1e-12 of scattering. The decay rates k are the singular values of
/// G^T F; its inverse is bidiagonal in the basis of AngularBasis, so that the eigenproblem is a tridiagonal
/// one, and its largest eigenvalues are the smallest k: the ones that matter most come out best.
///
/// s = shape a, t = dual b with a and b modal coefficients; dual is the inverse transpose of shape. Over a
/// thickness d, coefficients at the top and the bottom are bound by
///   b_top = k coth(k d) a_top - k / sinh(k d) a_bottom,   b_bottom = k / sinh(k d) a_top - k coth(k d)
///   a_bottom.
struct LayerModes {
    Eigen::VectorXd decay;     ///< k, 1/mm, descending
    Eigen::MatrixXd dual;      ///< streams x modes, sqrt(mm)
    Eigen::VectorXd net_flux;  ///< net downward flux carried by a unit of b, per mode

    /// @param layer that absorbs or scatters; its thickness is not read
    /// @param basis of the layer's index
    /// @param shape becomes, unless null, streams x modes, 1/sqrt(mm)
    LayerModes(const Layer& layer, const AngularBasis& basis, Eigen::MatrixXd* shape = nullptr);

    /// False for a layer that only absorbs: every mode is then one stream, and shape and dual have one entry
    /// in each row and column (streams ascend where modes descend: on the antidiagonal).
    bool scatters = true;
};

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
