#pragma once

#include <vector>

namespace skinglow::slab {

/// Nodes ascending and weights on [0, 1]; the weights sum to 1.
struct Quadrature {
    std::vector<double> node;
    std::vector<double> weight;
};

/// Gauss-Legendre rule of `count` nodes, exact to degree 2 count - 1.
Quadrature gauss_rule(int count);

/// Gauss-Radau rule of `count` nodes, one of them at the end given; exact to degree 2 count - 2. A beam from
/// that direction is then one of the streams.
enum class FixedNode { at_zero, at_one };
Quadrature radau_rule(int count, FixedNode end);

}  // namespace skinglow::slab
