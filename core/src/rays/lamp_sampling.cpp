#include "rays/lamp_sampling.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"
#include "rays/cone_sampling.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
/// Angular radius, radians, below which a lamp casts a sharp shadow.
constexpr double sharp = 1e-6;

/// A direction of the cap of that sine about an axis, evenly in solid angle.
glm::dvec3 on_cap(const glm::dvec3& axis, double sin_radius, double u, double v) {
    const double square = std::min(1.0, sin_radius * sin_radius);
    // 1 - cos of a small angle, without the cancellation.
    const double height = square / (1.0 + std::sqrt(1.0 - square));
    const double depth = u * height;
    const double radius = std::sqrt(depth * (2.0 - depth));
    const glm::dvec3 about_z(radius * std::cos(2 * pi * v), radius * std::sin(2 * pi * v), 1.0 - depth);
    return frame_around(axis) * about_z;
}

LampSample on_ball(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal, double u,
                   double v) {
    const double away = light.distance(point);
    const auto ball = light.ball_term(away);
    const glm::dvec3 towards = light.to_light(point);
    const glm::dvec3 direction =
        ball.inside ? on_cap(normal, 1.0, u, v) : on_cap(towards, ball.sin_radius, u, v);
    const double cosine = glm::dot(direction, towards);
    double distance = away / std::max(cosine, 1e-12);  // the disk that faces the place
    if (!light.soft_falloff()) {
        // Where the way meets the ball, first from outside, at the far side from within.
        const double sine_square = std::max(0.0, 1.0 - cosine * cosine);
        const double reach = light.radius();
        const double half_chord = std::sqrt(std::max(0.0, reach * reach - away * away * sine_square));
        distance = std::max(0.0, away * cosine + (ball.inside ? half_chord : -half_chord));
    }
    const double emission = light.spot() ? light.spot()->at(glm::dot(direction, -light.direction())) : 1.0;
    return {direction, distance, emission};
}

LampSample on_area(const PreparedLight& light, const glm::dvec3& point, double u, double v) {
    const AreaEmitter& area = *light.area();
    double x = 2.0 * u - 1.0;
    double y = 2.0 * v - 1.0;
    if (area.shape() == AreaShape::ellipse) {
        x = std::sqrt(u) * std::cos(2 * pi * v);
        y = std::sqrt(u) * std::sin(2 * pi * v);
    }
    const double scale = light.area_scale();
    const glm::dvec3 place = light.position() + light.frame()[0] * (x * area.half_x() * scale) +
                             light.frame()[1] * (y * area.half_y() * scale);
    const glm::dvec3 way = place - point;
    const double distance = std::hypot(way.x, way.y, way.z);
    if (!(distance > 0.0)) return {-light.direction(), 0.0, 1.0};
    if (!std::isfinite(distance)) return {light.to_light(point), distance, 1.0};
    const glm::dvec3 direction = way / distance;
    const double cos_emitter = std::clamp(-glm::dot(direction, light.direction()), 0.0, 1.0);
    if (cos_emitter == 0.0) return {direction, distance, 0.0};
    const double gain = area.gain(std::sqrt(1.0 - cos_emitter * cos_emitter) / cos_emitter);
    // Per square of the distance to the middle, so that nothing is beyond the largest double.
    const double nearness =
        std::max(light.distance(point), min_light_distance) / std::max(distance, min_light_distance);
    return {direction, distance, cos_emitter * gain * nearness * nearness};
}

}  // namespace

bool is_sharp(const PreparedLight& light, const glm::dvec3& point) {
    if (light.kind() == LightKind::sun) return light.sin_sun_radius() <= sharp;
    const double away = light.distance(point);
    if (light.kind() == LightKind::area) return 2.0 * light.area_scale() <= sharp * away;
    return light.ball_term(away).sin_radius <= sharp;
}

LampSample sample_lamp(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                       double u, double v) {
    if (light.kind() == LightKind::sun) {
        return {on_cap(-light.direction(), light.sin_sun_radius(), u, v),
                std::numeric_limits<double>::infinity(), 1.0};
    }
    return light.kind() == LightKind::area ? on_area(light, point, u, v)
                                           : on_ball(light, point, normal, u, v);
}

}  // namespace skinglow
