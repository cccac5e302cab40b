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

using std::numbers::pi;

/// Integral of f >= 0 between cuts that may stand outside [from, to]. About `peak` the variable is stretched by a
/// hyperbolic sine, so that a peak of any width is smooth in it, and a sine removes what rises like a square root at
/// the ends of a piece. The tolerance is relative to the whole.
template <std::size_t Count, typename Function>
double integrate_peak(const Function& f, double from, double to, std::array<double, Count> cuts, double peak,
                      double width, double tolerance) {
    for (double& cut : cuts) cut = std::clamp(cut, from, to);
    std::sort(cuts.begin(), cuts.end());
    const auto over_pieces = [&](const auto& integrate_piece) {
        double sum = 0;
        double begin = from;
        const auto add = [&](double end) {
            if (!(end > begin)) return;
            const double s0 = std::asinh((begin - peak) / width);
            const double s1 = std::asinh((end - peak) / width);
            const double center = 0.5 * (s0 + s1);
            const double half = 0.5 * (s1 - s0);
            sum += integrate_piece([&](double t) {
                const double s = center + half * std::sin(t);
                return half * std::cos(t) * width * std::cosh(s) *
                       f(std::clamp(peak + width * std::sinh(s), begin, end));
            });
            begin = end;
        };
        for (const double cut : cuts) add(cut);
        add(to);
        return sum;
    };
    const double estimate =
        over_pieces([](const auto& piece) { return integrate<8>(piece, -0.5 * pi, 0.5 * pi); });
    if (!(estimate > 0.0)) return 0.0;
    const double allowed = tolerance * estimate / static_cast<double>(Count + 1);
    return over_pieces(
        [&](const auto& piece) { return integrate_adaptively(piece, -0.5 * pi, 0.5 * pi, allowed, 7); });
}

/// Integral of (height + slope u) / (line_sq + u^2)^2 over [from, to], where it is not negative, to about 1e-9 of itself.
/// In closed form where that does not cancel, otherwise by Gauss's rule.
double across_strip(double height, double slope, double line_sq, double from, double to) {
    const auto at = [&](double u) {
        const double distance_sq = line_sq + u * u;
        return std::max(0.0, height + slope * u) / (distance_sq * distance_sq);
    };
    const double width = to - from;
    const double nearest = std::clamp(0.0, from, to);
    if (64.0 * width * width < line_sq + nearest * nearest) return integrate<6>(at, from, to);
    const double line = std::sqrt(line_sq);
    if (std::abs(nearest) > 4.0 * line) {
        const double end = nearest > 0.0 ? to : from;
        const double s0 = std::asinh(nearest / line);
        const double length = std::asinh(end / line) - s0;
        const double s1 = s0 + std::clamp(length, -6.0, 6.0);  // what is beyond is below 1e-7 of it
        const double sum =
            integrate<16>([&](double s) { return line * std::cosh(s) * at(line * std::sinh(s)); }, s0, s1);
        return std::abs(sum);
    }
    const double from_sq = line_sq + from * from;
    const double to_sq = line_sq + to * to;
    const double angle = std::atan2(width * line, line_sq + from * to);
    const double even = 0.5 * (width * (line_sq - from * to) / (from_sq * to_sq) + angle / line) / line_sq;
    const double odd = 0.5 * width * (from + to) / (from_sq * to_sq);
    return std::max(0.0, height * even + slope * odd);
}

/// Integral of f over [from, to], f being smooth but for what happens about 0 on the scale given.
template <typename Function>
double across_spread(const Function& f, double scale, double from, double to) {
    const auto side = [&](double begin, double end) {
        if (!(end > begin)) return 0.0;
        return integrate<24>([&](double s) { return scale * std::cosh(s) * f(scale * std::sinh(s)); },
                             std::asinh(begin / scale), std::asinh(end / scale));
    };
    return side(from, std::min(to, 0.0)) + side(std::max(from, 0.0), to);
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
    const auto half_width = [&](double x) {
        const double ratio = std::clamp(x / half_x, -1.0, 1.0);
        return shape_ == AreaShape::rectangle ? half_y : half_y * std::sqrt((1.0 - ratio) * (1.0 + ratio));
    };
    const auto strip = [&](double x) {
        const double width = half_width(x);
        const double dx = x - point.x;
        const double line_sq = dx * dx + h * h;
        const double height = normal.x * dx - normal.z * h;  // over the horizon, at the receiver's y
        // Only what is within the beam and above the horizon.
        const double rim = std::sqrt(std::max(0.0, beam_sq - dx * dx));
        double from = std::max(-width - point.y, -rim);
        double to = std::min(width - point.y, rim);
        const double horizon = -height / normal.y;
        if (normal.y > 0.0) from = std::max(from, horizon);
        if (normal.y < 0.0) to = std::min(to, horizon);
        if (!(to > from) || (normal.y == 0.0 && height <= 0.0)) return 0.0;
        if (!spreads_) return h * across_strip(height, normal.y, line_sq, from, to);
        const auto at = [&](double u) {
            const double distance_sq = line_sq + u * u;
            return std::max(0.0, height + normal.y * u) * gain(std::sqrt(dx * dx + u * u) / h) /
                   (distance_sq * distance_sq);
        };
        const double largest = std::max(std::abs(from), std::abs(to));
        return h * across_spread(at, std::max(std::abs(dx), std::min(h, 1e-3 * largest)), from, to);
    };
    // Where the horizon and the edge of the beam cross the rim and the axis.
    std::array<double, 14> cuts{point.x, point.x - std::sqrt(beam_sq), point.x + std::sqrt(beam_sq)};
    std::size_t count = 3;
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
