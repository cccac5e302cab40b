#include "numerics/gauss_legendre.h"

#include <cmath>
#include <numbers>

namespace skinglow::detail {
namespace {

template <std::size_t Count>
QuadratureRule<Count> make_rule() {
    QuadratureRule<Count> rule{};
    constexpr auto n = static_cast<double>(Count);
    for (std::size_t i = 0; i < Count; ++i) {
        double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
        double slope = 1;
        for (int step = 0; step < 20; ++step) {
            double previous = 1;
            double value = x;
            for (std::size_t k = 2; k <= Count; ++k) {
                const auto degree = static_cast<double>(k);
                const double next = ((2 * degree - 1) * x * value - (degree - 1) * previous) / degree;
                previous = value;
                value = next;
            }
            slope = n * (x * value - previous) / (x * x - 1);
            const double change = value / slope;
            x -= change;
            if (std::abs(change) < 1e-15) break;
        }
        rule.node[i] = x;
        rule.weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
    return rule;
}

}  // namespace

template <std::size_t Count>
const QuadratureRule<Count>& gauss_legendre() {
    static const QuadratureRule<Count> rule = make_rule<Count>();
    return rule;
}

template const QuadratureRule<1>& gauss_legendre<1>();
template const QuadratureRule<2>& gauss_legendre<2>();
template const QuadratureRule<4>& gauss_legendre<4>();
template const QuadratureRule<6>& gauss_legendre<6>();
template const QuadratureRule<8>& gauss_legendre<8>();
template const QuadratureRule<16>& gauss_legendre<16>();
template const QuadratureRule<24>& gauss_legendre<24>();

}  // namespace skinglow::detail
