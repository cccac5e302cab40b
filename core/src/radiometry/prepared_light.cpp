#include "radiometry/prepared_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace skinglow::detail {
namespace {

using std::numbers::pi;

/// A thinner light is as good as one this thin, in units of its width: a line.
constexpr double thinnest = 1e-8;
/// A light this small against its distance is a point with a cosine: the error is of second order.
constexpr double point_like = 1e-4;
/// A patch of this angular radius sees one value of a spot's profile.
constexpr double sharp = 1e-6;
/// Limits that keep the integrals within what doubles hold; each changes a result by far less than the
/// tolerance.
constexpr double narrowest_spread = 1e-6;  // radians
constexpr double smallest = 1e-12;         // scene unit; at min_light_distance already point_like
constexpr double lowest = 1e-9;            // height over an area light, in units of its width

}  // namespace

PreparedLight::PreparedLight(const Light& light) : kind_(light.kind()), position_(light.position()) {
    const auto* area = std::get_if<AreaLight>(&light.shape());
    if (kind_ != LightKind::point)
        frame_ = frame_around(light.direction(), area != nullptr ? area->tangent : glm::dvec3(1, 0, 0));
    std::visit(
        [this](const auto& shape) {
            if constexpr (requires { shape.radius; }) {
                radius_ = shape.radius;
                soft_falloff_ = shape.soft_falloff;
            }
        },
        light.shape());
    if (const auto* sun = std::get_if<SunLight>(&light.shape()))
        sin_sun_radius_ = std::sin(0.5 * sun->sun_angle);
    if (const auto* spot = std::get_if<SpotLight>(&light.shape())) {
        spot_.emplace(spot->spot_angle, spot->spot_blend, spot->spot_cosine);
        dark_ = spot->spot_angle == 0.0;
    }
    if (area == nullptr) return;
    // Cycles 3.4 to 5.2 gives no light from an area light with a size of exactly 0.
    dark_ = area->spread == 0.0 || area->size_x == 0.0 || area->size_y == 0.0;
    area_scale_ = std::max({0.5 * area->size_x, 0.5 * area->size_y, smallest});
    area_.emplace(area->area_shape, std::max(0.5 * area->size_x / area_scale_, thinnest),
                  std::max(0.5 * area->size_y / area_scale_, thinnest),
                  std::max(area->spread, narrowest_spread));
    radius_ = area_scale_ * std::hypot(area_->half_x(), area_->half_y());
}

glm::dvec3 PreparedLight::point_on_area(double x, double y) const {
    return position_ + area_scale_ * (x * area_->half_x() * frame_[0] + y * area_->half_y() * frame_[1]);
}

glm::dvec3 PreparedLight::to_light(const glm::dvec3& point) const {
    if (kind_ == LightKind::sun) return -direction();
    const glm::dvec3 half_offset =
        0.5 * position_ - 0.5 * point;  // the difference may be beyond the largest double
    if (half_offset == glm::dvec3(0.0)) return -direction();
    return unit(half_offset);
}

double PreparedLight::distance(const glm::dvec3& point) const {
    return kind_ == LightKind::sun ? 0.0 : length(position_ - point);
}

PreparedLight::BallTerm PreparedLight::ball_term(double distance) const {
    const double effective_distance =
        soft_falloff_ ? length(glm::dvec3(distance, radius_, 0.0)) : std::max(distance, radius_);
    const double clamped = std::max(effective_distance, min_light_distance);
    return {0.25 / pi / clamped / clamped, radius_ > 0.0 ? radius_ / effective_distance : 0.0,
            !soft_falloff_ && distance < radius_};
}

double PreparedLight::through_spot(const BallTerm& ball, const glm::dvec3& normal,
                                   const glm::dvec3& to_light) const {
    const glm::dvec3 to_spot = -direction();
    const double cos_angle = glm::dot(to_light, to_spot);
    const double cos_normal = glm::dot(normal, to_light);
    if (ball.sin_radius <= sharp) return spot_->at(cos_angle) * cap_irradiance(cos_normal, ball.sin_radius);
    const double radius = std::asin(std::min(1.0, ball.sin_radius));
    const double angle = std::atan2(glm::length(glm::cross(to_light, to_spot)), cos_angle);
    if (angle - radius >= spot_->edge()) return 0.0;
    if (angle + radius <= spot_->fade_start() && !spot_->with_cosine())
        return cap_irradiance(cos_normal, ball.sin_radius);
    return cap_irradiance_through_spot(*spot_, normal, to_light, to_spot, ball.sin_radius);
}

double PreparedLight::ball_irradiance(const glm::dvec3& point, const glm::dvec3& normal) const {
    const double distance = this->distance(point);
    const BallTerm ball = ball_term(distance);
    const glm::dvec3 to_center = to_light(point);
    const glm::dvec3& facing = distance == 0.0 ? to_center : normal;
    if (kind_ == LightKind::spot) return ball.facing * through_spot(ball, facing, to_center);
    return ball.facing *
           (ball.inside ? 1.0 : cap_irradiance(glm::dot(facing, to_center), std::min(1.0, ball.sin_radius)));
}

double PreparedLight::area_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                      double tolerance) const {
    const glm::dvec3 offset = point - position_;
    const double distance = std::max(length(offset), min_light_distance);
    const double height = glm::dot(offset, direction());
    if (!(height >= 0.0) || !std::isfinite(distance)) return 0.0;
    const double widest = 2.0 * area_scale_;
    if (widest <= point_like * distance * std::min(1.0, area_->half_spread())) {
        const double cos_emitter = std::min(1.0, std::max(height, min_light_distance) / distance);
        const double tangent = std::sqrt(1.0 - cos_emitter * cos_emitter) / cos_emitter;
        const double cos_normal = std::max(0.0, glm::dot(normal, to_light(point)));
        return cos_emitter * cos_normal * area_->gain(tangent) / pi / distance / distance;
    }
    glm::dvec3 local =
        (offset / area_scale_) * frame_;  // row vector times matrix: the transpose, the frame's inverse
    local.z = std::max({local.z, min_light_distance / area_scale_, lowest});
    const double per_radiance = area_->irradiance(local, normal * frame_, tolerance);
    return per_radiance / (pi * area_->area()) / area_scale_ / area_scale_;
}

double PreparedLight::irradiance(const glm::dvec3& point, const glm::dvec3& normal, double tolerance) const {
    if (dark_) return 0.0;
    if (kind_ == LightKind::sun) return cap_irradiance(-glm::dot(normal, direction()), sin_sun_radius_);
    if (kind_ == LightKind::area) return area_irradiance(point, normal, tolerance);
    return ball_irradiance(point, normal);
}

double PreparedLight::facing_irradiance(const glm::dvec3& point, double tolerance) const {
    if (kind_ == LightKind::sun) return 1.0;
    return irradiance(point, to_light(point), tolerance);
}

}  // namespace skinglow::detail
