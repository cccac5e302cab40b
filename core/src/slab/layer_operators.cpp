#include "slab/layer_operators.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

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

ModeFactors mode_factors(const Eigen::VectorXd& decay, double thickness) {
    // Below this a layer is transparent to rounding; its reciprocals must not overflow.
    const double d = std::max(thickness, 1e-200);
    ModeFactors factors{Eigen::VectorXd(decay.size()), Eigen::VectorXd(decay.size()),
                        Eigen::VectorXd(decay.size())};
    for (Eigen::Index i = 0; i < decay.size(); ++i) {
        const double k = decay[i];
        const double depth = k * d;
        const double passed = std::exp(-depth);
        const double lost = depth > 0 ? -std::expm1(-depth) / k : d;  // (1 - exp(-k d)) / k
        factors.symmetric[i] = k * (k * lost) / (1 + passed);
        factors.antisymmetric[i] = (1 + passed) / lost;
        factors.through[i] = 2 * passed / (lost * (1 + passed));
    }
    return factors;
}

LayerOperators layer_operators(const LayerModes& modes, double thickness) {
    const Eigen::Index n = modes.decay.size();
    if (!modes.scatters) {
        const Eigen::VectorXd passed = (-modes.decay.reverse() * thickness).array().exp();
        return {Eigen::MatrixXd::Zero(n, n), passed.asDiagonal()};
    }
    // Y maps s to t at the faces: of the symmetric and of the antisymmetric part of the light. The outgoing
    // light is (1 - Y)(1 + Y)^-1 of the incoming one; R and T are half the sum and half the difference, and
    // the difference is formed from k / sinh(k d) and not by subtraction.
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
    const auto inverse = [&](const Eigen::VectorXd& factor) -> Eigen::MatrixXd {  // of 1 + Y
        Eigen::MatrixXd system = identity;
        system.selfadjointView<Eigen::Lower>().rankUpdate(modes.dual * factor.cwiseSqrt().asDiagonal());
        return system.llt().solve(identity);
    };
    if (std::isinf(thickness)) return {2 * inverse(modes.decay) - identity, Eigen::MatrixXd::Zero(n, n)};
    const ModeFactors factors = mode_factors(modes.decay, thickness);
    const Eigen::MatrixXd symmetric = inverse(factors.symmetric);
    const Eigen::MatrixXd antisymmetric = inverse(factors.antisymmetric);
    LayerOperators layer;
    layer.reflection = symmetric + antisymmetric - identity;
    layer.transmission = 2 * ((antisymmetric * modes.dual) * factors.through.asDiagonal()) *
                         (modes.dual.transpose() * symmetric);
    return layer;
}

Crossing cross_boundary(const StreamGrid& grid, double n_from, double n_to,
                        const Eigen::MatrixXd& reflection_below) {
    const Eigen::Index from = grid.count(n_from);
    const Eigen::Index to = grid.count(n_to);
    const Eigen::Index common = std::min(from, to);
    Eigen::VectorXd r(common);
    for (Eigen::Index i = 0; i < common; ++i) r[i] = grid.reflectance(static_cast<int>(i), n_from, n_to);
    const Eigen::VectorXd passed = Eigen::VectorXd::Ones(common) - r;
    Crossing crossing{Eigen::MatrixXd::Zero(from, from), Eigen::MatrixXd::Zero(to, from)};
    crossing.reflection.diagonal().setOnes();  // total reflection where there is no stream on the other side
    crossing.reflection.diagonal().head(common) = r;
    crossing.transmission.topLeftCorner(common, common) = passed.asDiagonal();
    if (reflection_below.size() == 0) return crossing;

    // Light is sent back and forth between the boundary and what lies below: (1 - r R)^-1. A stream that is
    // trapped in an empty layer holds no light, but would make this singular: a total
    // reflection is one rounding short of 1.
    constexpr double total = 1 - std::numeric_limits<double>::epsilon() / 2;
    Eigen::VectorXd from_below = Eigen::VectorXd::Constant(to, total);
    from_below.head(common) = r;
    const Eigen::MatrixXd system =
        Eigen::MatrixXd::Identity(to, to) - from_below.asDiagonal() * reflection_below;
    crossing.transmission = system.partialPivLu().solve(crossing.transmission).eval();
    crossing.reflection.topRows(common) +=
        passed.asDiagonal() * (reflection_below.topRows(common) * crossing.transmission);
    return crossing;
}

Crossing cross_layer(const LayerOperators& layer, const Eigen::MatrixXd& reflection_below) {
    const Eigen::Index n = layer.reflection.rows();
    const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n) - layer.reflection * reflection_below;
    Crossing crossing;
    crossing.transmission = system.partialPivLu().solve(layer.transmission);
    crossing.reflection = layer.reflection + layer.transmission * (reflection_below * crossing.transmission);
    return crossing;
}

}  // namespace skinglow::detail
