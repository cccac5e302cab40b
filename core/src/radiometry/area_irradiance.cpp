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

constexpr double pi = std::numbers::pi;

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

/// The ellipse's rim from one eccentric angle to another, counter-clockwise, as a function to integrate.
class RimIntegrand {
  public:
    RimIntegrand(double half_x, double half_y, const Receiver& receiver, const SpreadIntegral* spread)
        : half_x_(half_x), half_y_(half_y), receiver_(receiver), spread_(spread) {}

    double operator()(double angle) const { return at(std::cos(angle), std::sin(angle)); }

    double at(double cosine, double sine) const {
        const glm::dvec3 to_rim = glm::dvec3(half_x_ * cosine, half_y_ * sine, 0.0) - receiver_.point;
        const glm::dvec3 motion(-half_x_ * sine, half_y_ * cosine, 0.0);
        if (spread_ == nullptr) {
            return -0.5 * glm::dot(receiver_.normal, glm::cross(to_rim, motion)) / glm::dot(to_rim, to_rim);
        }
        const double foot_distance_sq = to_rim.x * to_rim.x + to_rim.y * to_rim.y;
        if (foot_distance_sq == 0.0) return 0.0;
        const double distance = std::sqrt(foot_distance_sq);
        const glm::dvec2 c = spread_->coefficients(distance / receiver_.point.z);
        const double wedge = (to_rim.x * motion.y - to_rim.y * motion.x) / foot_distance_sq;
        const double along = (receiver_.normal.x * to_rim.x + receiver_.normal.y * to_rim.y) / distance;
        return wedge * (-receiver_.normal.z * c.x + along * c.y);
    }

    double distance_to(double angle) const {
        return glm::distance(receiver_.point,
                             glm::dvec3(half_x_ * std::cos(angle), half_y_ * std::sin(angle), 0.0));
    }
    /// Eccentric angle of the rim point nearest to the receiver, by circles of curvature.
    double nearest_angle() const {
        const glm::dvec2 half(half_x_, half_y_);
        const glm::dvec2 foot = glm::abs(glm::dvec2(receiver_.point));
        const double focal_sq = half_x_ * half_x_ - half_y_ * half_y_;
        glm::dvec2 t(std::numbers::sqrt2 / 2);  // cosine and sine of the angle, in the first quadrant
        for (int step = 0; step < 6; ++step) {
            const glm::dvec2 center = glm::dvec2(focal_sq, -focal_sq) * t * t * t / half;
            const double radius = glm::distance(half * t, center);
            const double distance = std::max(glm::distance(foot, center), 1e-300);
            const glm::dvec2 next = glm::max(((foot - center) * (radius / distance) + center) / half, 0.0);
            if (!(glm::length(next) > 0.0)) break;
            t = glm::normalize(next);
        }
        return std::atan2(std::copysign(t.y, receiver_.point.y), std::copysign(t.x, receiver_.point.x));
    }

  private:
    double half_x_;
    double half_y_;
    Receiver receiver_;
    const SpreadIntegral* spread_;
};

/// Pieces that shrink towards the point of the rim next to the receiver, so that a rule meets no feature
/// narrower than its piece; then halved where they still disagree.
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
        for (std::size_t i = first; i < rim_points; i += step) sum += rim.at(table[i].x, table[i].y);
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

double AreaEmitter::irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const {
    if (point.z <= 0.0) return 0.0;
    if (spreads_) {
        const double aside = std::hypot(std::max(0.0, std::abs(point.x) - half_x_),
                                        std::max(0.0, std::abs(point.y) - half_y_));
        if (aside >= tan_half_ * point.z) return 0.0;  // exactly, where the integral would leave its rounding
    }
    if (is_thin()) return strip_irradiance(half_x_, half_y_, point, normal, tolerance);
    const double value = shape_ == AreaShape::rectangle ? rectangle_irradiance(point, normal, tolerance)
                                                        : ellipse_irradiance(point, normal, tolerance);
    return std::max(0.0, value);
}

double AreaEmitter::rectangle_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                         double tolerance) const {
    const Receiver receiver{point, normal};
    const Polygon polygon = part_above_horizon(half_x_, half_y_, receiver);
    double sum = 0;
    if (!spreads_) {
        for (std::size_t i = 0; i < polygon.count; ++i) {
            sum += lambert_edge(polygon.corner[i], polygon.corner[(i + 1) % polygon.count], receiver);
        }
        return sum;
    }
    const double distance = glm::length(point);
    const double scale = std::min(pi, area() * axis_gain() / (distance * distance));
    const SpreadIntegral spread(tan_half_);
    const glm::dvec2 foot(point.x, point.y);
    for (std::size_t i = 0; i < polygon.count; ++i) {
        sum += spread.edge((polygon.corner[i] - foot) / point.z,
                           (polygon.corner[(i + 1) % polygon.count] - foot) / point.z, {normal.x, normal.y},
                           normal.z, 0.1 * tolerance * scale * spread_norm_);
    }
    return sum / spread_norm_;
}

double AreaEmitter::ellipse_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                       double tolerance) const {
    const Receiver receiver{point, normal};
    const double extent_x = normal.x * half_x_;
    const double extent_y = normal.y * half_y_;
    const double extent = std::hypot(extent_x, extent_y);
    const double center_height = -glm::dot(normal, point);
    if (center_height <= -extent) return 0.0;
    const double distance = glm::length(point);
    const double scale = std::min(pi, area() * axis_gain() / (distance * distance));
    const double absolute = 0.3 * tolerance * scale * spread_norm_;
    const SpreadIntegral spread(tan_half_);
    const RimIntegrand rim(half_x_, half_y_, receiver, spreads_ ? &spread : nullptr);
    const double widest = std::max(half_x_, half_y_);
    const bool whole = center_height >= extent;
    double sum = 0;
    // Two coarse rules may agree by missing a feature together: only where there is none. The distance to the box
    // around the ellipse is a lower bound of that to its rim.
    const double outside =
        std::hypot(std::max(0.0, std::abs(point.x) - half_x_), std::max(0.0, std::abs(point.y) - half_y_));
    const double beam = spreads_ ? tan_half_ * point.z : widest;
    if (whole && std::min(std::hypot(outside, point.z), beam) > 0.5 * widest &&
        integrate_whole_rim(rim, absolute, sum)) {
        return sum / spread_norm_;
    }
    const double feature = std::min(rim.distance_to(rim.nearest_angle()), beam);
    const double finest = 0.25 * feature / widest;
    if (whole) return integrate_rim(rim, -pi, pi, finest, absolute) / spread_norm_;
    const double center_angle = std::atan2(extent_y, extent_x);
    const double half_arc = std::acos(std::clamp(-center_height / extent, -1.0, 1.0));
    sum = integrate_rim(rim, center_angle - half_arc, center_angle + half_arc, finest, absolute);
    // The straight cut along the horizon closes the rim.
    const auto rim_point = [&](double angle) {
        return glm::dvec2(half_x_ * std::cos(angle), half_y_ * std::sin(angle));
    };
    const glm::dvec2 end = rim_point(center_angle + half_arc);
    const glm::dvec2 begin = rim_point(center_angle - half_arc);
    const glm::dvec2 foot(point.x, point.y);
    sum += spreads_ ? spread.edge((end - foot) / point.z, (begin - foot) / point.z, {normal.x, normal.y},
                                  normal.z, absolute)
                    : lambert_edge(end, begin, receiver);
    return sum / spread_norm_;
}

}  // namespace skinglow::detail
