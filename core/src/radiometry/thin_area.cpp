#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "numerics/quadrature.h"
#include "radiometry/area_irradiance.h"

namespace skinglow::detail {
namespace {

constexpr double pi = std::numbers::pi;

/// Integral of f between ascending cuts that may stand outside [from, to]. About `peak` the variable is stretched by
/// a hyperbolic sine, so that a peak of any width is smooth in it, and a sine takes away what rises like a square root
/// at the ends of a piece.
template <std::size_t Count, typename Function>
double integrate_peak(const Function& f, double from, double to, std::array<double, Count> cuts, double peak,
                      double width, double tolerance) {
    for (double& cut : cuts) cut = std::clamp(cut, from, to);  // NaN stays and is no piece
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    double begin = from;
    const auto add = [&](double end) {
        if (!(end > begin)) return;
        const double s0 = std::asinh((begin - peak) / width);
        const double s1 = std::asinh((end - peak) / width);
        const double center = 0.5 * (s0 + s1);
        const double half = 0.5 * (s1 - s0);
        const auto stretched = [&](double t) {
            const double s = center + half * std::sin(t);
            return half * std::cos(t) * width * std::cosh(s) *
                   f(std::clamp(peak + width * std::sinh(s), begin, end));
        };
        const double size = integrate<8>(stretched, -0.5 * pi, 0.5 * pi);
        sum += integrate_adaptively(stretched, -0.5 * pi, 0.5 * pi, tolerance * std::abs(size));
        begin = end;
    };
    for (const double cut : cuts) add(cut);
    add(to);
    return sum;
}

}  // namespace

bool AreaEmitter::is_thin() const {
    const double aspect = std::min(half_x_, half_y_) / std::max(half_x_, half_y_);
    return aspect < (shape_ == AreaShape::rectangle ? 1e-4 : 1e-2);
}

// By strips across the long axis. Nothing is subtracted, so the error is relative however thin the light is.
double AreaEmitter::strip_irradiance(double half_x, double half_y, const glm::dvec3& point,
                                     const glm::dvec3& normal, double tolerance) const {
    if (half_y > half_x) {
        return strip_irradiance(half_y, half_x, {point.y, point.x, point.z}, {normal.y, normal.x, normal.z},
                                tolerance);
    }
    const double h = point.z;
    const double beam_sq = spreads_ ? tan_half_ * h * tan_half_ * h : INFINITY;
    constexpr double in_strip = 1e-12;  // else the integral over strips would chase its noise
    const auto half_width = [&](double x) {
        const double ratio = std::clamp(x / half_x, -1.0, 1.0);
        return shape_ == AreaShape::rectangle ? half_y : half_y * std::sqrt((1.0 - ratio) * (1.0 + ratio));
    };
    const auto strip = [&](double x) {
        const double width = half_width(x);
        const double dx = x - point.x;
        const double line_sq = dx * dx + h * h;
        const double height = normal.x * dx - normal.z * h;  // over the horizon, at the receiver's y
        const auto at = [&](double u) {
            const double distance_sq = line_sq + u * u;
            const double above = std::max(0.0, height + normal.y * u);
            return h * above * gain(std::sqrt(dx * dx + u * u) / h) / (distance_sq * distance_sq);
        };
        const double from = -width - point.y;
        const double to = width - point.y;
        const double horizon = -height / normal.y;
        const double rim = std::sqrt(beam_sq - dx * dx);
        const double nearest = std::clamp(0.0, from, to);
        const bool is_smooth =
            !(horizon > from && horizon < to) && !(rim > from && rim < to) && !(-rim > from && -rim < to);
        // Narrow against its distance: one rule does.
        if (is_smooth && 64.0 * width * width < line_sq + nearest * nearest)
            return integrate<6>(at, from, to);
        return integrate_peak(at, from, to, std::array{horizon, -rim, rim, 0.0}, 0.0, std::sqrt(line_sq),
                              in_strip);
    };
    // Where the horizon and the edge of the beam cross the rim and the axis.
    std::array<double, 12> cuts{point.x};
    std::size_t count = 1;
    for (const double side : {-1.0, 0.0, 1.0}) {
        cuts[count++] = point.x + (normal.z * h - normal.y * (side * half_y - point.y)) / normal.x;
        for (const double sign : {-1.0, 1.0}) {
            double x = point.x;
            for (int step = 0; step < 8; ++step) {
                const double aside = side * half_width(x) - point.y;
                x = point.x + sign * std::sqrt(beam_sq - aside * aside);
            }
            cuts[count++] = x;
        }
    }
    if (shape_ == AreaShape::ellipse) {
        const glm::dvec2 extent(normal.x * half_x, normal.y * half_y);
        const double half_arc = std::acos(glm::dot(normal, point) / glm::length(extent));
        const double center = std::atan2(extent.y, extent.x);
        cuts[count++] = half_x * std::cos(center - half_arc);
        cuts[count++] = half_x * std::cos(center + half_arc);
    }
    for (double& cut : cuts) cut = std::isfinite(cut) ? cut : half_x;
    const double aside = std::max(0.0, std::abs(point.y) - half_y);
    return integrate_peak(strip, -half_x, half_x, cuts, point.x, std::hypot(h, aside), 0.1 * tolerance);
}

}  // namespace skinglow::detail
