#include "numerics/quadrature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

namespace skinglow::detail {
namespace {

// Off-diagonal of the Jacobi matrix of the Legendre polynomials on [-1, 1].
Eigen::VectorXd legendre_recurrence(std::size_t count) {
    Eigen::VectorXd off(static_cast<Eigen::Index>(count) - 1);
    for (Eigen::Index i = 0; i < off.size(); ++i) {
        const auto degree = static_cast<double>(i + 1);
        off[i] = degree / std::sqrt(4 * degree * degree - 1);
    }
    return off;
}

// Golub and Welsch (1969, Math Comp 23:221): nodes are the eigenvalues, weights the squared first components.
Quadrature rule_of_jacobi_matrix(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal) {
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, off_diagonal);
    Quadrature rule;
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
        rule.node.push_back(0.5 * (1 + solver.eigenvalues()[i]));
        rule.weight.push_back(solver.eigenvectors()(0, i) * solver.eigenvectors()(0, i));
    }
    return rule;
}

Quadrature make_rule(std::size_t count, FixedNode fixed) {
    const Eigen::VectorXd off = legendre_recurrence(count);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(off.size() + 1);
    if (fixed == FixedNode::none) return rule_of_jacobi_matrix(diagonal, off);
    if (count == 1) return {{fixed == FixedNode::at_one ? 1.0 : 0.0}, {1.0}};
    // Golub (1973, SIAM Review 15:318): the last diagonal entry is chosen so that the end is an eigenvalue.
    double ratio = 1;  // p_k(1) / p_(k-1)(1) of the monic polynomials
    for (Eigen::Index k = 0; k + 1 < off.size(); ++k) ratio = 1 - off[k] * off[k] / ratio;
    diagonal[off.size()] = 1 - off[off.size() - 1] * off[off.size() - 1] / ratio;
    Quadrature rule = rule_of_jacobi_matrix(diagonal, off);
    rule.node.back() = 1;
    if (fixed == FixedNode::at_one) return rule;
    std::ranges::reverse(rule.node);
    std::ranges::reverse(rule.weight);
    for (double& node : rule.node) node = 1 - node;
    return rule;
}

}  // namespace

const Quadrature& gauss_rule(std::size_t count, FixedNode fixed) {
    static std::mutex mutex;
    static std::map<std::pair<FixedNode, std::size_t>, Quadrature>
        rules;  // which leaves its entries where they are
    const std::scoped_lock lock(mutex);
    const std::pair key(fixed, count);
    const auto found = rules.find(key);
    return found != rules.end() ? found->second : rules.emplace(key, make_rule(count, fixed)).first->second;
}

}  // namespace skinglow::detail
