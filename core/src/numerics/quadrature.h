#pragma once

#include <cstddef>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Nodes ascending and weights on [0, 1]; the weights sum to 1.
struct Quadrature {
    std::vector<double> node;
    std::vector<double> weight;
};

enum class FixedNode { none, at_zero, at_one };

/// Gauss-Legendre rule of `count` nodes, exact to degree 2 count - 1; with a node fixed at an end the Gauss-Radau rule,
/// exact to one degree less. Each rule is computed once and kept.
const Quadrature& gauss_rule(std::size_t count, FixedNode fixed = FixedNode::none);

/// The Gauss-Legendre rule of a fixed number of nodes, found without a search.
template <std::size_t Count>
const Quadrature& gauss_legendre() {
    static const Quadrature& rule = gauss_rule(Count);
    return rule;
}

/// An integral, and the integral of the absolute value by the same rule: what rounding errors scale with.
struct IntegralWithSize {
    double value = 0;
    double size = 0;
};

template <std::size_t Count, typename Function>
IntegralWithSize integrate_with_size(const Function& f, double a, double b) {
    const Quadrature& rule = gauss_legendre<Count>();
    IntegralWithSize sum;
    for (std::size_t i = 0; i < Count; ++i) {
        const double term = (b - a) * rule.weight[i] * f(a + (b - a) * rule.node[i]);
        sum.value += term;
        sum.size += term < 0 ? -term : term;
    }
    return sum;
}

/// Integral of f from a to b by a fixed rule.
template <std::size_t Count, typename Function>
double integrate(const Function& f, double a, double b) {
    return integrate_with_size<Count>(f, a, b).value;
}

/// Integral of f from a to b: an interval is halved until a rule of 8 nodes agrees with one of 4 on it, to
/// the tolerance (absolute; the error of the value returned is far smaller for a smooth f) or to rounding, at
/// most ten times.
template <typename Function>
double integrate_adaptively(const Function& f, double a, double b, double tolerance, int halvings = 10) {
    const IntegralWithSize fine = integrate_with_size<8>(f, a, b);
    const double change = fine.value - integrate<4>(f, a, b);
    const double allowed = tolerance > 1e-13 * fine.size ? tolerance : 1e-13 * fine.size;
    if (halvings == 0 || (change <= allowed && -change <= allowed)) return fine.value;
    const double center = 0.5 * (a + b);
    return integrate_adaptively(f, a, center, 0.5 * tolerance, halvings - 1) +
           integrate_adaptively(f, center, b, 0.5 * tolerance, halvings - 1);
}

}  // namespace skinglow::detail
