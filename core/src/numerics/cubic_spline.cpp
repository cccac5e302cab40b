#include "numerics/cubic_spline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/argument_check.h"

namespace skinglow::detail {
namespace {

/// Slope at the end of a row of values, by the polynomial through the first five (or as many as there are).
double end_slope(const double* y, std::ptrdiff_t step, std::size_t count) {
    switch (count) {
        case 2:
            return y[step] - y[0];
        case 3:
            return -1.5 * y[0] + 2.0 * y[step] - 0.5 * y[2 * step];
        case 4:
            return (-11.0 * y[0] + 18.0 * y[step] - 9.0 * y[2 * step] + 2.0 * y[3 * step]) / 6.0;
        default:
            return (-25.0 * y[0] + 48.0 * y[step] - 36.0 * y[2 * step] + 16.0 * y[3 * step] -
                    3.0 * y[4 * step]) /
                   12.0;
    }
}

}  // namespace

CubicSpline::CubicSpline(std::size_t knots, std::span<const double> places) : knots_(knots) {
    if (knots < 2) refuse_argument("number of knots", std::to_string(knots), "2 or more");
    intervals_.reserve(places.size());
    for (const double place : places) {
        if (!(place >= 0.0 && place <= static_cast<double>(knots - 1))) {
            refuse_argument("place of interpolation", to_text(place), "0 to " + std::to_string(knots - 1));
        }
        const std::size_t start = std::min(static_cast<std::size_t>(place), knots - 2);
        const double t = place - static_cast<double>(start);
        const double rest = 1.0 - t;
        intervals_.push_back(
            {start, (1.0 + 2.0 * t) * rest * rest, t * t * (3.0 - 2.0 * t), t * rest * rest, -t * t * rest});
    }
    pivot_.assign(knots, 1.0);
    for (std::size_t i = 1; i + 1 < knots; ++i) pivot_[i] = 1.0 / (i == 1 ? 4.0 : 4.0 - pivot_[i - 1]);
}

void CubicSpline::evaluate(std::span<const double> values, std::span<double> out) const {
    const std::size_t n = knots_;
    std::vector<double> slope(n);
    slope.front() = end_slope(values.data(), 1, n);
    slope.back() = -end_slope(values.data() + (n - 1), -1, n);
    // Continuous curvature inside: m[i-1] + 4 m[i] + m[i+1] = 3 (y[i+1] - y[i-1]), solved by elimination.
    for (std::size_t i = 1; i + 1 < n; ++i) {
        double right = 3.0 * (values[i + 1] - values[i - 1]);
        if (i + 2 == n) right -= slope.back();
        slope[i] = pivot_[i] * (right - slope[i - 1]);
    }
    for (std::size_t i = n - 2; i-- > 1;) slope[i] -= pivot_[i] * slope[i + 1];
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
        const Interval& at = intervals_[i];
        out[i] = at.value_start * values[at.start] + at.value_end * values[at.start + 1] +
                 at.slope_start * slope[at.start] + at.slope_end * slope[at.start + 1];
    }
}

}  // namespace skinglow::detail
