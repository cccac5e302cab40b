#include "rays/visible_fraction.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

using std::numbers::pi;
/// Angular radius, radians, below which a light casts a sharp shadow.
constexpr double sharp = 1e-6;

}  // namespace

double LightSampler::sine_at(const PreparedLight& light, double distance) {
    if (light.kind() == LightKind::sun) return light.sin_sun_radius();
    if (light.kind() == LightKind::area) return light.area_scale() / std::max(distance, min_light_distance);
    return light.ball_term(distance).sin_radius;
}

LightSampler::LightSampler(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal)
    : light_(&light),
      point_(point),
      normal_(normal),
      to_center_(light.to_light(point)),
      distance_(light.distance(point)) {
    if (light.kind() == LightKind::area) {
        is_sharp_ = 2.0 * light.area_scale() <= sharp * distance_;
        return;
    }
    double sine = light.sin_sun_radius();
    if (light.kind() == LightKind::sun) {
        distance_ = std::numeric_limits<double>::infinity();
    } else {
        const PreparedLight::BallTerm ball = light.ball_term(distance_);
        sine = ball.sin_radius;
        inside_ = ball.inside;
    }
    is_sharp_ = sine <= sharp;
    if (is_sharp_) return;
    frame_ = frame_around(inside_ ? normal : to_center_);
    const double sin_sq = inside_ ? 1.0 : std::min(1.0, sine * sine);
    // 1 - cos of a small angle, without the cancellation.
    cap_height_ = sin_sq / (1.0 + std::sqrt(1.0 - sin_sq));
}

glm::dvec3 LightSampler::on_cap(double u, double v) const {
    const double depth = u * cap_height_;
    const double radius = std::sqrt(depth * (2.0 - depth));
    return frame_ * glm::dvec3(radius * std::cos(2 * pi * v), radius * std::sin(2 * pi * v), 1.0 - depth);
}

LightSample LightSampler::on_ball(double u, double v) const {
    const glm::dvec3 direction = on_cap(u, v);
    const double cosine = glm::dot(direction, to_center_);
    double distance = distance_ / std::max(cosine, 1e-12);  // the disk that faces the point
    if (!light_->soft_falloff()) {
        // Where the ray meets the ball: on the near side from outside, on the far side from within.
        const double off_center = distance_ * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const double chord_sq = light_->radius() * light_->radius() - off_center * off_center;
        const double half_chord = std::sqrt(std::max(0.0, chord_sq));
        distance = std::max(0.0, distance_ * cosine + (inside_ ? half_chord : -half_chord));
    }
    const double emission =
        light_->spot() ? light_->spot()->at(glm::dot(direction, -light_->direction())) : 1.0;
    return {direction, distance, emission};
}

LightSample LightSampler::on_area(double u, double v) const {
    const AreaEmitter& area = *light_->area();
    double x = 2.0 * u - 1.0;
    double y = 2.0 * v - 1.0;
    if (area.shape() == AreaShape::ellipse) {
        x = std::sqrt(u) * std::cos(2 * pi * v);
        y = std::sqrt(u) * std::sin(2 * pi * v);
    }
    const double scale = light_->area_scale();
    const glm::dvec3 target = light_->position() + light_->frame()[0] * (x * area.half_x() * scale) +
                              light_->frame()[1] * (y * area.half_y() * scale);
    const glm::dvec3 offset = target - point_;
    const double distance = length(offset);
    if (!(distance > 0.0)) return {-light_->direction(), 0.0, 1.0};
    if (!std::isfinite(distance)) return {to_center_, distance, 1.0};
    const glm::dvec3 direction = offset / distance;
    const double cos_emitter = std::clamp(-glm::dot(direction, light_->direction()), 0.0, 1.0);
    if (cos_emitter == 0.0) return {direction, distance, 0.0};
    const double gain = area.gain(std::sqrt(1.0 - cos_emitter * cos_emitter) / cos_emitter);
    // Relative to the squared distance of the center, so that nothing is beyond the largest double.
    const double nearness = std::max(distance_, min_light_distance) / std::max(distance, min_light_distance);
    return {direction, distance, cos_emitter * gain * nearness * nearness};
}

LightSample LightSampler::at(double u, double v) const {
    if (light_->kind() == LightKind::sun) return {on_cap(u, v), distance_, 1.0};
    return light_->kind() == LightKind::area ? on_area(u, v) : on_ball(u, v);
}

}  // namespace skinglow::detail
