#include "numerics/quadrature.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <mutex>

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

Quadrature make_gauss_rule(std::size_t count) {
    return rule_of_jacobi_matrix(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count)),
                                 legendre_recurrence(count));
}

Quadrature make_radau_rule(std::size_t count, FixedNode end) {
    if (count == 1) return {{end == FixedNode::at_one ? 1.0 : 0.0}, {1.0}};
    // Golub (1973, SIAM Review 15:318): the last diagonal entry is chosen so that the end is an eigenvalue.
    const Eigen::VectorXd off = legendre_recurrence(count);
    double ratio = 1;  // p_k(1) / p_(k-1)(1) of the monic polynomials
    for (Eigen::Index k = 0; k + 1 < off.size(); ++k) ratio = 1 - off[k] * off[k] / ratio;
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(off.size() + 1);
    diagonal[off.size()] = 1 - off[off.size() - 1] * off[off.size() - 1] / ratio;
    Quadrature rule = rule_of_jacobi_matrix(diagonal, off);
    rule.node.back() = 1;
    if (end == FixedNode::at_one) return rule;
    Quadrature mirrored;
    for (std::size_t i = rule.node.size(); i-- > 0;) {
        mirrored.node.push_back(1 - rule.node[i]);
        mirrored.weight.push_back(rule.weight[i]);
    }
    return mirrored;
}

// The rules made so far, by number of nodes.
class RuleCache {
  public:
    template <typename Make>
    const Quadrature& rule(std::size_t count, const Make& make) {
        const std::scoped_lock lock(mutex_);
        const auto found = rules_.find(count);
        return found != rules_.end() ? found->second : rules_.emplace(count, make()).first->second;
    }

  private:
    std::mutex mutex_;
    std::map<std::size_t, Quadrature> rules_;  // which leaves its entries where they are
};

}  // namespace

const Quadrature& gauss_rule(std::size_t count) {
    static RuleCache cache;
    return cache.rule(count, [&] { return make_gauss_rule(count); });
}

const Quadrature& radau_rule(std::size_t count, FixedNode end) {
    static RuleCache at_zero;
    static RuleCache at_one;
    return (end == FixedNode::at_zero ? at_zero : at_one).rule(count, [&] {
        return make_radau_rule(count, end);
    });
}

}  // namespace skinglow::detail
