#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Cubic spline through values at even knots 0, 1, ... n - 1, its end slopes from the polynomial through the
/// first and last five values: of fourth order. Made once for a set of places and used for many sets of
/// values.
class CubicSpline {
  public:
    /// @param knots 2 or more; @param places in [0, knots - 1], where values are wanted. Else
    /// std::invalid_argument.
    CubicSpline(std::size_t knots, std::span<const double> places);

    std::size_t knots() const { return knots_; }
    std::size_t places() const { return intervals_.size(); }

    /// @param values one per knot; @param out one per place
    void evaluate(std::span<const double> values, std::span<double> out) const;

  private:
    struct Interval {
        std::size_t start;
        double value_start, value_end, slope_start, slope_end;  // Hermite weights
    };
    std::size_t knots_;
    std::vector<Interval> intervals_;
    std::vector<double> pivot_;  // of the tridiagonal system of the spline
};

}  // namespace skinglow::detail
