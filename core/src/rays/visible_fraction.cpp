#include "rays/visible_fraction.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

constexpr double pi = std::numbers::pi;
/// Angular radius, radians, below which a light casts a sharp shadow.
constexpr double sharp = 1e-6;

/// A direction within the cap of that angular radius about an axis, uniform in solid angle.
glm::dvec3 on_cap(const glm::dvec3& axis, double sin_radius, double u, double v) {
    const double sin_sq = std::min(1.0, sin_radius * sin_radius);
    // 1 - cos of a small angle, without the cancellation.
    const double height = sin_sq / (1.0 + std::sqrt(1.0 - sin_sq));
    const double depth = u * height;
    const double radius = std::sqrt(depth * (2.0 - depth));
    const glm::dvec3 about_z(radius * std::cos(2 * pi * v), radius * std::sin(2 * pi * v), 1.0 - depth);
    return frame_around(axis) * about_z;
}

LightSample on_ball(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal, double u,
                    double v) {
    const double center_distance = light.distance(point);
    const auto ball = light.ball_term(center_distance);
    const glm::dvec3 to_center = light.to_light(point);
    const glm::dvec3 direction =
        ball.inside ? on_cap(normal, 1.0, u, v) : on_cap(to_center, ball.sin_radius, u, v);
    const double cosine = glm::dot(direction, to_center);
    double distance = center_distance / std::max(cosine, 1e-12);  // the disk that faces the point
    if (!light.soft_falloff()) {
        // Where the ray meets the ball: on the near side from outside, on the far side from within.
        const double off_center = center_distance * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const double chord_sq = light.radius() * light.radius() - off_center * off_center;
        const double half_chord = std::sqrt(std::max(0.0, chord_sq));
        distance = std::max(0.0, center_distance * cosine + (ball.inside ? half_chord : -half_chord));
    }
    const double emission = light.spot() ? light.spot()->at(glm::dot(direction, -light.direction())) : 1.0;
    return {direction, distance, emission};
}

LightSample on_area(const PreparedLight& light, const glm::dvec3& point, double u, double v) {
    const AreaEmitter& area = *light.area();
    double x = 2.0 * u - 1.0;
    double y = 2.0 * v - 1.0;
    if (area.shape() == AreaShape::ellipse) {
        x = std::sqrt(u) * std::cos(2 * pi * v);
        y = std::sqrt(u) * std::sin(2 * pi * v);
    }
    const double scale = light.area_scale();
    const glm::dvec3 target = light.position() + light.frame()[0] * (x * area.half_x() * scale) +
                              light.frame()[1] * (y * area.half_y() * scale);
    const glm::dvec3 offset = target - point;
    const double distance = length(offset);
    if (!(distance > 0.0)) return {-light.direction(), 0.0, 1.0};
    if (!std::isfinite(distance)) return {light.to_light(point), distance, 1.0};
    const glm::dvec3 direction = offset / distance;
    const double cos_emitter = std::clamp(-glm::dot(direction, light.direction()), 0.0, 1.0);
    if (cos_emitter == 0.0) return {direction, distance, 0.0};
    const double gain = area.gain(std::sqrt(1.0 - cos_emitter * cos_emitter) / cos_emitter);
    // Relative to the squared distance of the center, so that nothing is beyond the largest double.
    const double nearness =
        std::max(light.distance(point), min_light_distance) / std::max(distance, min_light_distance);
    return {direction, distance, cos_emitter * gain * nearness * nearness};
}

}  // namespace

bool is_sharp(const PreparedLight& light, const glm::dvec3& point) {
    if (light.kind() == LightKind::sun) return light.sin_sun_radius() <= sharp;
    const double center_distance = light.distance(point);
    if (light.kind() == LightKind::area) return 2.0 * light.area_scale() <= sharp * center_distance;
    return light.ball_term(center_distance).sin_radius <= sharp;
}

LightSample sample_light(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                         double u, double v) {
    if (light.kind() == LightKind::sun) {
        return {on_cap(-light.direction(), light.sin_sun_radius(), u, v),
                std::numeric_limits<double>::infinity(), 1.0};
    }
    return light.kind() == LightKind::area ? on_area(light, point, u, v)
                                           : on_ball(light, point, normal, u, v);
}

}  // namespace skinglow::detail
