#include "radiometry/area_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "numerics/quadrature.h"
#include "radiometry/spread_integral.h"

namespace skinglow::detail {
namespace {

using std::numbers::pi;

struct Receiver {
    glm::dvec3 point;
    glm::dvec3 normal;

    /// Height of a point on the light over the receiver's horizon, times a length.
    double above_horizon(const glm::dvec2& point_2d) const {
        return glm::dot(normal, glm::dvec3(point_2d, 0.0) - point);
    }
};

/// A rectangle cut by one line has at most five corners.
struct Polygon {
    std::array<glm::dvec2, 5> corner;
    std::size_t count = 0;
    void add(const glm::dvec2& point_2d) { corner[count++] = point_2d; }
};

Polygon part_above_horizon(double half_x, double half_y, const Receiver& receiver) {
    const std::array<glm::dvec2, 4> corner = {glm::dvec2(-half_x, -half_y), glm::dvec2(half_x, -half_y),
                                              glm::dvec2(half_x, half_y), glm::dvec2(-half_x, half_y)};
    Polygon kept;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2& here = corner[i];
        const glm::dvec2& next = corner[(i + 1) % 4];
        const double height = receiver.above_horizon(here);
        const double next_height = receiver.above_horizon(next);
        if (height >= 0.0) kept.add(here);
        if ((height >= 0.0) != (next_height >= 0.0) && kept.count < kept.corner.size()) {
            kept.add(here + (next - here) * (height / (height - next_height)));
        }
    }
    return kept;
}

/// Lambert's term of one straight edge: half the angle it is seen under, times the normal's component across
/// it.
double lambert_edge(const glm::dvec2& a, const glm::dvec2& b, const Receiver& receiver) {
    const glm::dvec3 to_a = glm::dvec3(a, 0.0) - receiver.point;
    const glm::dvec3 to_b = glm::dvec3(b, 0.0) - receiver.point;
    // a x (b - a), not a x b: the difference is exact where a and b are nearly parallel.
    const glm::dvec3 across = glm::cross(to_a, glm::dvec3(b - a, 0.0));
    const double length = glm::length(across);
    if (length == 0.0) return 0.0;
    return -0.5 * std::atan2(length, glm::dot(to_a, to_b)) * glm::dot(receiver.normal, across) / length;
}

/// The ellipse's rim, counter-clockwise, as a function of the eccentric angle to integrate.
struct RimIntegrand {
    glm::dvec2 half;
    Receiver receiver;
    const SpreadIntegral* spread;  ///< none: Lambert

    double operator()(double angle) const { return at({std::cos(angle), std::sin(angle)}); }

    double at(const glm::dvec2& unit) const {
        const glm::dvec3 to_rim = glm::dvec3(half * unit, 0.0) - receiver.point;
        const glm::dvec3 motion(-half.x * unit.y, half.y * unit.x, 0.0);
        if (spread == nullptr) {
            return -0.5 * glm::dot(receiver.normal, glm::cross(to_rim, motion)) / glm::dot(to_rim, to_rim);
        }
        const glm::dvec2 foot_to_rim(to_rim);
        const double distance_sq = glm::dot(foot_to_rim, foot_to_rim);
        if (distance_sq == 0.0) return 0.0;
        const double wedge = (to_rim.x * motion.y - to_rim.y * motion.x) / distance_sq;
        return wedge * spread->along_ray(foot_to_rim / receiver.point.z, receiver.normal);
    }

    glm::dvec2 point(double angle) const { return half * glm::dvec2(std::cos(angle), std::sin(angle)); }
    /// Eccentric angle of the rim point nearest to the receiver, by circles of curvature.
    double nearest_angle() const {
        const glm::dvec2 foot = glm::abs(glm::dvec2(receiver.point));
        const double focal_sq = half.x * half.x - half.y * half.y;
        glm::dvec2 t(std::numbers::sqrt2 / 2);  // cosine and sine of the angle, in the first quadrant
        for (int step = 0; step < 6; ++step) {
            const glm::dvec2 center = glm::dvec2(focal_sq, -focal_sq) * t * t * t / half;
            const double radius = glm::distance(half * t, center);
            const double distance = std::max(glm::distance(foot, center), 1e-300);
            const glm::dvec2 next = glm::max(((foot - center) * (radius / distance) + center) / half, 0.0);
            if (!(glm::length(next) > 0.0)) break;
            t = glm::normalize(next);
        }
        return std::atan2(std::copysign(t.y, receiver.point.y), std::copysign(t.x, receiver.point.x));
    }
};

/// Subdivision graded towards the rim point nearest to the receiver, so that a rule meets no feature narrower than its
/// piece; then adaptive.
double integrate_rim(const RimIntegrand& rim, double from, double to, double finest, double tolerance) {
    std::vector<double> cuts = {from, to};
    const double near = rim.nearest_angle();
    double step = std::clamp(finest, 1e-12, pi / 4);
    while (step < pi) {
        for (const double turn : {-2 * pi, 0.0, 2 * pi}) {
            for (const double cut : {near + turn - step, near + turn, near + turn + step}) {
                if (cut > from && cut < to) cuts.push_back(cut);
            }
        }
        step *= 2;
    }
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    const double allowed = tolerance / static_cast<double>(cuts.size());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (cuts[i + 1] > cuts[i]) sum += integrate_adaptively(rim, cuts[i], cuts[i + 1], allowed);
    }
    return sum;
}

/// Points of the trapezoidal rule around the rim; a rule of half as many is every second one.
constexpr std::size_t rim_points = 256;

const std::array<glm::dvec2, rim_points>& rim_table() {
    static const std::array<glm::dvec2, rim_points> table = [] {
        std::array<glm::dvec2, rim_points> points{};
        for (std::size_t i = 0; i < rim_points; ++i) {
            const double angle = 2 * pi * static_cast<double>(i) / rim_points;
            points[i] = {std::cos(angle), std::sin(angle)};
        }
        return points;
    }();
    return table;
}

/// The whole rim by the trapezoidal rule, whose error for a smooth periodic function falls like a geometric
/// series; false where all points do not settle it (the receiver is too near).
bool integrate_whole_rim(const RimIntegrand& rim, double tolerance, double& result) {
    const std::array<glm::dvec2, rim_points>& table = rim_table();
    const auto sum_of = [&](std::size_t first, std::size_t step) {
        double sum = 0;
        for (std::size_t i = first; i < rim_points; i += step) sum += rim.at(table[i]);
        return sum;
    };
    double sum = sum_of(0, rim_points / 8);
    double before = sum * 2 * pi / 8;
    for (std::size_t count = 16; count <= rim_points; count *= 2) {
        sum += sum_of(rim_points / count, 2 * rim_points / count);
        result = sum * 2 * pi / static_cast<double>(count);
        // The next doubling would change it by the square of this change: the tolerance is met long before.
        if (std::abs(result - before) <= tolerance) return true;
        before = result;
    }
    return false;
}

}  // namespace

AreaEmitter::AreaEmitter(AreaShape shape, double half_x, double half_y, double spread)
    : shape_(shape), half_x_(half_x), half_y_(half_y), half_spread_(0.5 * spread), spreads_(spread < pi) {
    if (!spreads_) return;
    tan_half_ = std::tan(half_spread_);
    spread_norm_ = tangent_minus_angle(tan_half_);
}

double AreaEmitter::area() const {
    return (shape_ == AreaShape::rectangle ? 4.0 : pi) * half_x_ * half_y_;
}

double AreaEmitter::gain(double tan_angle) const {
    return spreads_ ? std::max(0.0, (tan_half_ - tan_angle) / spread_norm_) : 1.0;
}

double AreaEmitter::aside(const glm::dvec3& point) const {
    return std::hypot(std::max(0.0, std::abs(point.x) - half_x_), std::max(0.0, std::abs(point.y) - half_y_));
}

double AreaEmitter::irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const {
    if (point.z <= 0.0) return 0.0;
    // Exactly, where the integral would leave its rounding.
    if (spreads_ && aside(point) >= tan_half_ * point.z) return 0.0;
    if (is_thin()) return strip_irradiance(half_x_, half_y_, point, normal, tolerance);
    const double value = shape_ == AreaShape::rectangle ? rectangle_irradiance(point, normal, tolerance)
                                                        : ellipse_irradiance(point, normal, tolerance);
    return std::max(0.0, value);
}

double AreaEmitter::edge_irradiance(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec3& point,
                                    const glm::dvec3& normal, double tolerance) const {
    if (!spreads_) return lambert_edge(a, b, {point, normal});
    const glm::dvec2 foot(point);
    return SpreadIntegral(tan_half_).edge((a - foot) / point.z, (b - foot) / point.z, normal, tolerance);
}

double AreaEmitter::rectangle_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                         double tolerance) const {
    const Polygon polygon = part_above_horizon(half_x_, half_y_, {point, normal});
    double sum = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& next = polygon.corner[(i + 1) % polygon.count];
        sum += edge_irradiance(polygon.corner[i], next, point, normal, 0.1 * tolerance * scale_at(point));
    }
    return sum / spread_norm_;
}

/// What tolerances are relative to, times spread_norm_.
double AreaEmitter::scale_at(const glm::dvec3& point) const {
    return std::min(pi, area() * axis_gain() / glm::dot(point, point)) * spread_norm_;
}

double AreaEmitter::ellipse_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                       double tolerance) const {
    const glm::dvec2 extents(normal.x * half_x_, normal.y * half_y_);
    const double extent = std::hypot(extents.x, extents.y);
    const double center_height = -glm::dot(normal, point);
    if (center_height <= -extent) return 0.0;
    const double absolute = 0.3 * tolerance * scale_at(point);
    const SpreadIntegral spread(tan_half_);
    const RimIntegrand rim{{half_x_, half_y_}, {point, normal}, spreads_ ? &spread : nullptr};
    const double widest = std::max(half_x_, half_y_);
    const bool whole = center_height >= extent;
    double sum = 0;
    // Two coarse rules may agree by missing a feature together: only where there is none. The distance to the box
    // around the ellipse is a lower bound of that to its rim.
    const double beam = spreads_ ? tan_half_ * point.z : widest;
    if (whole && std::min(std::hypot(aside(point), point.z), beam) > 0.5 * widest &&
        integrate_whole_rim(rim, absolute, sum)) {
        return sum / spread_norm_;
    }
    const glm::dvec3 nearest(rim.point(rim.nearest_angle()), 0.0);
    const double feature = std::min(glm::distance(point, nearest), beam);
    const double finest = 0.25 * feature / widest;
    if (whole) return integrate_rim(rim, -pi, pi, finest, absolute) / spread_norm_;
    const double center_angle = std::atan2(extents.y, extents.x);
    const double half_arc = std::acos(std::clamp(-center_height / extent, -1.0, 1.0));
    sum = integrate_rim(rim, center_angle - half_arc, center_angle + half_arc, finest, absolute);
    // The straight cut along the horizon closes the rim.
    sum += edge_irradiance(rim.point(center_angle + half_arc), rim.point(center_angle - half_arc), point,
                           normal, absolute);
    return sum / spread_norm_;
}

}  // namespace skinglow::detail
