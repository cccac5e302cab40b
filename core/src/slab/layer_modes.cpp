#include "slab/layer_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace skinglow::detail {
namespace {

// Without absorption the smallest k is 0 and the eigenproblem infinite. This much, as a fraction of
// scattering, stands for none: over an optical thickness of 1e6 it takes less than 1e-16 of the light.
constexpr double min_absorption = 1e-24;

}  // namespace

LayerModes::LayerModes(const Layer& layer, const AngularBasis& basis, Eigen::MatrixXd* shape) {
    const Eigen::VectorXd& mu = basis.cosine;
    const Eigen::Index n = mu.size();
    const double flux_scale = layer.refractive_index * std::sqrt(basis.weight_sum);
    const double attenuation = layer.absorption + layer.scattering;
    if (layer.scattering <= 0) {
        scatters = false;
        // Streams ascend in n sin(theta), hence also in 1 / mu; modes descend in k.
        decay = attenuation * mu.cwiseInverse().reverse();
        if (shape != nullptr) *shape = Eigen::MatrixXd::Zero(n, n);
        dual = Eigen::MatrixXd::Zero(n, n);
        net_flux.resize(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Eigen::Index mode = n - 1 - i;
            if (shape != nullptr) (*shape)(i, mode) = std::sqrt(attenuation / mu[i]);
            dual(i, mode) = std::sqrt(mu[i] / attenuation);
            net_flux[mode] = flux_scale * basis.even(i, 0) * mu[i] / std::sqrt(attenuation);
        }
        return;
    }

    // absorption + scattering (1 - g^l), in units of the attenuation: squares of the coefficients could
    // overflow.
    const double absorption = layer.absorption / attenuation;
    const double scattering = layer.scattering / attenuation;
    Eigen::VectorXd even(n);
    Eigen::VectorXd odd(n);
    double moment = 1;
    for (Eigen::Index i = 0; i < n; ++i) {
        even[i] = absorption + scattering * (1 - moment);
        moment *= layer.anisotropy;
        odd[i] = absorption + scattering * (1 - moment);
        moment *= layer.anisotropy;
    }
    even[0] = std::max(absorption, min_absorption * scattering);

    // (G^T F)^-1 = E^-1/2 Q_even^T mu Q_odd O^-1/2 is lower bidiagonal; its product with its transpose has
    // the eigenvalues 1 / k^2.
    const auto recurrence = [&](Eigen::Index l) { return basis.recurrence[l - 1]; };
    Eigen::VectorXd diagonal(n);
    Eigen::VectorXd off_diagonal(n - 1);
    for (Eigen::Index i = 0; i < n; ++i) {
        const double own = recurrence(2 * i + 1);
        diagonal[i] = own * own / even[i];
        if (i + 1 < n) {
            const double next = recurrence(2 * i + 2);
            diagonal[i] += next * next / even[i + 1];
            off_diagonal[i] = next * recurrence(2 * i + 3) / (even[i + 1] * std::sqrt(odd[i] * odd[i + 1]));
        }
        diagonal[i] /= odd[i];
    }
    // Ordered so that its largest entry stands first, the matrix is graded the way the QR steps keep exact.
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, off_diagonal);
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    // No mode decays faster than this; rounding must not make one that does.
    const double smallest = 0.125 * mu.minCoeff() * mu.minCoeff();
    decay = attenuation * solver.eigenvalues().cwiseMax(smallest).cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd root_odd = std::sqrt(attenuation) * odd.cwiseSqrt();
    const Eigen::VectorXd root_mu = mu.cwiseSqrt();
    if (shape != nullptr) {
        shape->noalias() =
            (root_mu.cwiseInverse().asDiagonal() * basis.odd) * (root_odd.asDiagonal() * vectors);
    }
    dual.noalias() = (root_mu.asDiagonal() * basis.odd) * (root_odd.cwiseInverse().asDiagonal() * vectors);
    net_flux = flux_scale * recurrence(1) / root_odd[0] * vectors.row(0).transpose();
}

}  // namespace skinglow::detail
