#pragma once

#include <Eigen/Core>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Orthonormal polynomials on the streams of one medium, the discrete counterpart of the Legendre
/// polynomials.
///
/// The phase function enters as sum over l of g^l q_l q_l^T. With sampled Legendre polynomials a rule that is
/// not exact to degree 4N leaks energy, and even when renormalized gives wrong anisotropy; these are
/// orthonormal on the rule itself, so that energy and mean cosine are kept to rounding, and since 2N of them
/// span everything on N + N streams, the forward peak (delta-M, Wiscombe 1977, J Atmos Sci 34:1408) is
/// contained and not cut off.
struct AngularBasis {
    Eigen::VectorXd cosine;
    Eigen::MatrixXd even;  ///< streams x N: column i is sqrt(w) q_(2i)
    Eigen::MatrixXd odd;   ///< streams x N: column i is sqrt(w) q_(2i+1)
    /// mu q_l = r_(l+1) q_(l+1) + r_l q_(l-1): entry l - 1 is r_l, l = 1 to 2N - 1.
    Eigen::VectorXd recurrence;
    double weight_sum = 1;  ///< of the rule before normalization; 1 but for its error

    /// @param cosine the rule's nodes on one hemisphere
    /// @param weight the rule's weights
    AngularBasis(Eigen::VectorXd cosine, const Eigen::VectorXd& weight);
};

}  // namespace skinglow::detail
