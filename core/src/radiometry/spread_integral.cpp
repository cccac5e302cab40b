#include "radiometry/spread_integral.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "numerics/quadrature.h"

namespace skinglow::detail {
namespace {

/// Integral of x^2 / (1 + x^2)^2 from 0.
double second_moment(double x) {
    const double s = x * x;
    if (x < small_tangent)
        return x * s * (1.0 / 3 + s * (-2.0 / 5 + s * (3.0 / 7 + s * (-4.0 / 9 + s * 5.0 / 11))));
    return 0.5 * (std::atan(x) - x / (1 + s));
}

/// Integral of x^3 / (1 + x^2)^2 from 0.
double third_moment(double x) {
    const double s = x * x;
    if (x < small_tangent)
        return s * s * (1.0 / 4 + s * (-2.0 / 6 + s * (3.0 / 8 + s * (-4.0 / 10 + s * 5.0 / 12))));
    return 0.5 * (std::log1p(s) - s / (1 + s));
}

}  // namespace

double tangent_minus_angle(double tangent) {
    const double s = tangent * tangent;
    if (tangent < small_tangent) return tangent * s * tangent_series(s);
    return tangent - std::atan(tangent);
}

double SpreadIntegral::along_ray(const glm::dvec2& point, const glm::dvec3& normal) const {
    const double x = glm::length(point);
    if (x == 0.0) return 0.0;
    const double end = std::min(x, tan_half_);
    const double first = 0.5 * end * end / (1 + end * end);
    const double second = second_moment(end);
    return -normal.z * (tan_half_ * first - second) +
           glm::dot(glm::dvec2(normal), point) / x * (tan_half_ * second - third_moment(end));
}

double SpreadIntegral::edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec3& normal,
                            double tolerance) const {
    const double length = glm::distance(a, b);
    if (length == 0.0) return 0.0;
    const glm::dvec2 along = (b - a) / length;
    const double offset = a.x * along.y - a.y * along.x;  // distance of the edge's line to the foot, signed
    if (offset == 0.0) return 0.0;
    const glm::dvec2 nearest = glm::dvec2(along.y, -along.x) * offset;
    // By the angle under which the receiver itself sees the edge: every scale of distances is smooth in it.
    const double scale = std::sqrt(1.0 + offset * offset);
    const double from = std::atan(glm::dot(a, along) / scale);
    const double to = std::atan(glm::dot(b, along) / scale);
    const auto integrand = [&](double angle) {
        const double tangent = std::tan(angle);
        const glm::dvec2 on_edge = nearest + along * (scale * tangent);
        const double radius_sq = glm::dot(on_edge, on_edge);
        if (radius_sq == 0.0) return 0.0;
        const double wedge = offset * scale * (1 + tangent * tangent) / radius_sq;  // d(phi) / d(angle)
        return wedge * along_ray(on_edge, normal);
    };
    // Where the edge enters and leaves the disk beyond which the light does not shine.
    const double radius_sq = tan_half_ * tan_half_ - offset * offset;
    const double kink = radius_sq > 0 ? std::atan(std::sqrt(radius_sq) / scale) : 0.0;
    const double first = std::clamp(-kink, from, to);
    const double last = std::clamp(kink, from, to);
    double sum = 0;
    for (const glm::dvec2& piece : {glm::dvec2(from, first), glm::dvec2(first, last), glm::dvec2(last, to)}) {
        if (piece.y > piece.x) sum += integrate_adaptively(integrand, piece.x, piece.y, tolerance);
    }
    return sum;
}

}  // namespace skinglow::detail
