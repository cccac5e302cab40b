#include "radiometry/cap_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/quadrature.h"
#include "radiometry/spread_integral.h"

namespace skinglow::detail {
namespace {

using std::numbers::pi;

/// A circle of directions at one angle to the spot's axis is cut by the patch and by the horizon; what is
/// left of it are one or two arcs. The azimuth counts from the center of the patch.
struct CircleOfDirections {
    double patch_angle;     ///< of the center of the patch to the axis
    double patch_radius;    ///< angular
    double normal_angle;    ///< of the receiver's normal to the axis
    double normal_azimuth;  ///< 0 to pi

    /// Integral of the cosine to the receiver's normal over the arcs.
    double cosine_over_arcs(double angle) const {
        const double patch_half = patch_half_arc(angle);
        const double constant_term = std::cos(angle) * std::cos(normal_angle);
        const double cosine_term = std::sin(angle) * std::sin(normal_angle);
        // Above the horizon where constant_term + cosine_term cos(azimuth - normal_azimuth) > 0.
        double horizon_half = constant_term > 0 ? pi : 0.0;
        if (cosine_term > std::abs(constant_term)) horizon_half = std::acos(-constant_term / cosine_term);
        double sum = 0;
        for (const double turn : {0.0, 2 * pi}) {
            const double center = normal_azimuth - turn;
            const double from = std::max(-patch_half, center - horizon_half);
            const double to = std::min(patch_half, center + horizon_half);
            if (to > from)
                sum += constant_term * (to - from) +
                       cosine_term * (std::sin(to - center) - std::sin(from - center));
        }
        return sum;
    }

    double patch_half_arc(double angle) const {
        if (angle + patch_angle <= patch_radius) return pi;
        const double separation = std::abs(angle - patch_angle);
        if (separation >= patch_radius) return 0.0;
        // Half-angle form of the spherical law of cosines: nothing cancels for small patches.
        const double sin_half_sq = std::sin(0.5 * (patch_radius + separation)) *
                                   std::sin(0.5 * (patch_radius - separation)) /
                                   (std::sin(angle) * std::sin(patch_angle));
        return sin_half_sq >= 1.0 ? pi : 2.0 * std::asin(std::sqrt(sin_half_sq));
    }
};

/// Angles to the axis where the rim of the patch meets the horizon; unused points hold 0.
std::array<double, 2> rim_on_horizon(const glm::dvec3& normal, const glm::dvec3& to_light,
                                     const glm::dvec3& to_spot, double radius) {
    const double g = glm::dot(normal, to_light);
    const double rest = 1.0 - g * g;
    if (rest < 1e-14) return {0.0, 0.0};
    const double along = std::cos(radius) / rest;
    const double sin_half_sq = (1.0 - std::cos(radius) * along) / rest;
    if (sin_half_sq <= 0.0) return {0.0, 0.0};
    const glm::dvec3 center = along * (to_light - g * normal);
    const glm::dvec3 side = std::sqrt(sin_half_sq) * glm::cross(to_light, normal);
    return {angle_between(center + side, to_spot), angle_between(center - side, to_spot)};
}

}  // namespace

SpotProfile::SpotProfile(double angle, double blend, bool with_cosine)
    : edge_(0.5 * angle),
      cos_edge_(std::cos(edge_)),
      // 1 - cos of a small angle, without the cancellation.
      fade_(blend * 2.0 * std::sin(0.5 * edge_) * std::sin(0.5 * edge_)),
      fade_start_(2.0 * std::asin(std::sin(0.5 * edge_) * std::sqrt(1.0 - blend))),
      with_cosine_(with_cosine) {}

double SpotProfile::at(double cos_angle) const {
    const double inside = cos_angle - cos_edge_;
    if (inside <= 0.0) return 0.0;
    double fraction = 1.0;
    if (inside < fade_) {
        const double t = inside / fade_;
        fraction = t * t * (3.0 - 2.0 * t);
    }
    return with_cosine_ ? fraction * std::max(0.0, cos_angle) : fraction;
}

double cap_irradiance(double cos_normal, double sin_radius) {
    if (cos_normal >= sin_radius) return cos_normal;
    if (cos_normal <= -sin_radius) return 0.0;
    const double cos_radius = std::sqrt(std::max(0.0, 1.0 - sin_radius * sin_radius));
    const double sin_normal = std::sqrt(std::max(0.0, 1.0 - cos_normal * cos_normal));
    const double rise = std::clamp(-cos_radius * cos_normal / (sin_radius * sin_normal), -1.0, 1.0);
    const double chord = sin_normal * std::sqrt(1.0 - rise * rise);
    // The patch's rim, (angle - tangent) / tan^2, and the horizon's, the angle: small patches by the series of the
    // difference, which would cancel.
    const double per_radius = chord / cos_radius;
    const double tangent = per_radius * sin_radius;
    const double rest = tangent < small_tangent
                            ? tangent * (1.0 - per_radius * per_radius * tangent_series(tangent * tangent))
                            : std::atan2(chord * sin_radius, cos_radius) / (sin_radius * sin_radius) -
                                  cos_radius * chord / sin_radius;
    return std::clamp((cos_normal * std::acos(rise) + rest) / std::numbers::pi, 0.0, 1.0);
}

double cap_irradiance_through_spot(const SpotProfile& profile, const glm::dvec3& normal,
                                   const glm::dvec3& to_light, const glm::dvec3& to_spot, double sin_radius) {
    CircleOfDirections circle{};
    circle.patch_angle = angle_between(to_light, to_spot);
    circle.patch_radius = std::asin(std::min(1.0, sin_radius));
    circle.normal_angle = angle_between(normal, to_spot);
    const glm::dvec3 patch_side = to_light - glm::dot(to_light, to_spot) * to_spot;
    const glm::dvec3 normal_side = normal - glm::dot(normal, to_spot) * to_spot;
    circle.normal_azimuth = angle_between(normal_side, patch_side);

    const double from = std::max(0.0, circle.patch_angle - circle.patch_radius);
    const double to = std::min(profile.edge(), circle.patch_angle + circle.patch_radius);
    if (to <= from) return 0.0;
    const std::array<double, 2> corners = rim_on_horizon(normal, to_light, to_spot, circle.patch_radius);
    std::array<double, 7> cuts = {from,
                                  to,
                                  profile.fade_start(),
                                  std::abs(circle.patch_angle - circle.patch_radius),
                                  std::abs(0.5 * pi - circle.normal_angle),
                                  corners[0],
                                  corners[1]};
    for (double& cut : cuts) cut = std::clamp(cut, from, to);
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double center = 0.5 * (cuts[i] + cuts[i + 1]);
        const double half = 0.5 * (cuts[i + 1] - cuts[i]);
        if (half <= 0.0) continue;
        // Arcs open like a square root at the ends of a piece; the sine substitution removes that.
        sum += half * integrate<16>(
                          [&](double x) {
                              const double angle = center + half * std::sin(x);
                              return std::cos(x) * std::sin(angle) * profile.at(std::cos(angle)) *
                                     circle.cosine_over_arcs(angle);
                          },
                          -0.5 * pi, 0.5 * pi);
    }
    return std::clamp(sum / (pi * sin_radius * sin_radius), 0.0, 1.0);
}

}  // namespace skinglow::detail
