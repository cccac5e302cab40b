#include "numerics/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skinglow {
namespace {

double moment(const Quadrature& rule, int degree) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) sum += rule.weight[i] * std::pow(rule.node[i], degree);
    return sum;
}

TEST(Quadrature, GaussIsExactToTwiceItsNodesLessOne) {
    for (std::size_t count = 1; count <= 40; ++count) {
        const Quadrature rule = gauss_rule(count);
        const int exact = 2 * static_cast<int>(count) - 1;
        for (int degree = 0; degree <= exact; ++degree) {
            EXPECT_NEAR(moment(rule, degree), 1.0 / (degree + 1), 4e-15) << count << " nodes, x^" << degree;
        }
        if (count < 6) {
            EXPECT_GT(std::abs(moment(rule, exact + 1) - 1.0 / (exact + 2)), 1e-8);
        }
    }
}

TEST(Quadrature, RadauHasItsNodeAtTheEnd) {
    for (std::size_t count = 1; count <= 40; ++count) {
        for (const FixedNode end : {FixedNode::at_zero, FixedNode::at_one}) {
            const Quadrature rule = gauss_rule(count, end);
            EXPECT_EQ(end == FixedNode::at_one ? rule.node.back() : rule.node.front(),
                      end == FixedNode::at_one ? 1.0 : 0.0);
            for (int degree = 0; degree <= 2 * static_cast<int>(count) - 2; ++degree) {
                EXPECT_NEAR(moment(rule, degree), 1.0 / (degree + 1), 2e-14) << count << ", x^" << degree;
            }
        }
    }
}

TEST(Quadrature, FixedRuleIntegratesOverAnyInterval) {
    EXPECT_NEAR(integrate<8>([](double x) { return std::exp(x); }, -1, 2), std::exp(2) - std::exp(-1), 1e-12);
    EXPECT_NEAR(integrate<8>([](double x) { return x; }, 2, -1), -1.5, 1e-14);  // from right to left
    const IntegralWithSize odd = integrate_with_size<8>([](double x) { return x; }, -1, 1);
    EXPECT_NEAR(odd.value, 0, 1e-15);
    EXPECT_NEAR(odd.size, 1, 0.02);
}

TEST(Quadrature, AdaptiveRuleFindsAPeak) {
    constexpr double width = 1e-2;
    int calls = 0;
    const auto peak = [&calls](double x) {
        ++calls;
        return 1 / (width * width + x * x);
    };
    const double exact = 2 * std::atan(1 / width) / width;
    EXPECT_NEAR(integrate_adaptively(peak, -1, 1, 1e-8), exact, 1e-8);
    EXPECT_GT(std::abs(integrate<24>(peak, -1, 1) - exact), 1);  // where a fixed rule does not
    EXPECT_LT(calls, 5000);
}

}  // namespace
}  // namespace skinglow
