#include "numerics/cubic_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace skinglow {
namespace {

std::vector<double> even_places(double last, std::size_t count) {
    std::vector<double> places(count);
    for (std::size_t i = 0; i < count; ++i)
        places[i] = last * static_cast<double>(i) / static_cast<double>(count - 1);
    return places;
}

double largest_error_on_exponential(std::size_t knots) {
    const auto curve = [&](double place) { return std::exp(-3.0 * place / static_cast<double>(knots - 1)); };
    const auto places = even_places(static_cast<double>(knots - 1), 1001);
    std::vector<double> values(knots), out(places.size());
    for (std::size_t i = 0; i < knots; ++i) values[i] = curve(static_cast<double>(i));
    CubicSpline(knots, places).evaluate(values, out);
    double error = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
        error = std::max(error, std::abs(out[i] - curve(places[i])));
    return error;
}

TEST(CubicSpline, GoesThroughItsKnots) {
    const std::vector<double> values{5.0, 4.5, 4.4, 1.0, 0.5, -7.0}, places{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    std::vector<double> out(6);
    CubicSpline(6, places).evaluate(values, out);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(out[i], values[i]);
}

TEST(CubicSpline, IsExactForStraightLinesAndCubics) {
    for (const std::size_t knots : {2U, 3U, 4U, 5U, 9U}) {
        const auto places = even_places(static_cast<double>(knots - 1), 50);
        std::vector<double> line(knots), cubic(knots), out(50);
        const auto fall = [](double x) { return -x * x * x - 40.0 * x * x - 50.0 * x; };
        for (std::size_t i = 0; i < knots; ++i) {
            line[i] = 2.0 - 3.0 * static_cast<double>(i);
            cubic[i] = fall(static_cast<double>(i));
        }
        CubicSpline(knots, places).evaluate(line, out);
        for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(out[i], 2.0 - 3.0 * places[i], 1e-12);
        if (knots < 4) continue;
        CubicSpline(knots, places).evaluate(cubic, out);
        for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(out[i], fall(places[i]), 1e-10);
    }
}

TEST(CubicSpline, IsOfFourthOrder) {
    const double coarse = largest_error_on_exponential(17), fine = largest_error_on_exponential(33);
    EXPECT_NEAR(coarse / fine, 16.0, 3.0);
}

TEST(CubicSpline, RefusesPlacesOutside) {
    const std::vector<double> outside{2.5}, negative{-0.1}, inside{0.5};
    EXPECT_THROW(CubicSpline(3, outside), std::invalid_argument);
    EXPECT_THROW(CubicSpline(3, negative), std::invalid_argument);
    EXPECT_THROW(CubicSpline(1, inside), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
