#pragma once

#include <array>
#include <cstddef>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Nodes and weights on [-1, 1].
template <std::size_t Count>
struct QuadratureRule {
    std::array<double, Count> node;
    std::array<double, Count> weight;
};

/// Gauss-Legendre rule, computed once by Newton's method on the Legendre polynomial; exact to degree 2 Count
/// - 1.
template <std::size_t Count>
const QuadratureRule<Count>& gauss_legendre();

/// Integral of f from a to b by a fixed rule.
template <std::size_t Count, typename Function>
double integrate(const Function& f, double a, double b) {
    const QuadratureRule<Count>& rule = gauss_legendre<Count>();
    const double middle = 0.5 * (a + b);
    const double half = 0.5 * (b - a);
    double sum = 0;
    for (std::size_t i = 0; i < Count; ++i) sum += rule.weight[i] * f(middle + half * rule.node[i]);
    return half * sum;
}

/// An integral, and the integral of the absolute value by the same rule: the measure of what rounding can do
/// to it.
struct IntegralWithSize {
    double value = 0;
    double size = 0;
};

template <std::size_t Count, typename Function>
IntegralWithSize integrate_with_size(const Function& f, double a, double b) {
    const QuadratureRule<Count>& rule = gauss_legendre<Count>();
    const double middle = 0.5 * (a + b);
    const double half = 0.5 * (b - a);
    IntegralWithSize sum;
    for (std::size_t i = 0; i < Count; ++i) {
        const double term = half * rule.weight[i] * f(middle + half * rule.node[i]);
        sum.value += term;
        sum.size += term < 0 ? -term : term;
    }
    return sum;
}

/// Integral of f from a to b: an interval is halved until a rule of 8 places agrees with one of 4 on it, to
/// the tolerance (absolute; the error of the value returned is far smaller for a smooth f) or to rounding, at
/// most ten times.
template <typename Function>
double integrate_adaptively(const Function& f, double a, double b, double tolerance, int halvings = 10) {
    const IntegralWithSize fine = integrate_with_size<8>(f, a, b);
    const double change = fine.value - integrate<4>(f, a, b);
    const double allowed = tolerance > 1e-13 * fine.size ? tolerance : 1e-13 * fine.size;
    if (halvings == 0 || (change <= allowed && -change <= allowed)) return fine.value;
    const double middle = 0.5 * (a + b);
    return integrate_adaptively(f, a, middle, 0.5 * tolerance, halvings - 1) +
           integrate_adaptively(f, middle, b, 0.5 * tolerance, halvings - 1);
}

}  // namespace skinglow::detail
