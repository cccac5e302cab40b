#include "rig/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
/// Rounding of the values and of the bounds themselves, far above what either amounts to.
constexpr double rounding = 1e-9;

/// Half the angle under which a ball is seen; pi from within.
double half_angle(double distance, double radius) {
    return distance > radius ? std::asin(radius / distance) : pi;
}

/// A spot's profile seen from the box: the lamp's own radius blurs it by as much as the lamp is wide.
IrradianceRange spot_range(const PreparedLight& light, const Box& box) {
    const glm::dvec3 to_box = box.center() - light.position();
    const double blur =
        std::asin(std::min(1.0, light.ball_term(box.min_distance(light.position())).sin_radius));
    const double least = min_angle(light.direction(), to_box, box.radius()) - blur;
    const double largest = max_angle(light.direction(), to_box, box.radius()) + blur;
    return {light.spot()->at(std::cos(std::min(largest, pi))),
            light.spot()->at(std::cos(std::max(least, 0.0)))};
}

IrradianceRange ball_range(const PreparedLight& light, const Box& box) {
    IrradianceRange range{light.ball_term(box.max_distance(light.position())).facing,
                          light.ball_term(box.min_distance(light.position())).facing};
    if (light.kind() != LightKind::spot) return range;
    const IrradianceRange spot = spot_range(light, box);
    // Where the lamp fills more than the half sky, a facing surface is no measure of its profile.
    return {light.radius() < box.min_distance(light.position()) ? range.min * spot.min : 0.0,
            range.max * spot.max};
}

double distance_between(const Box& a, const Box& b) {
    const glm::dvec3 gap = glm::max(glm::max(a.min - b.max, b.min - a.max), glm::dvec3(0.0));
    return length(gap);
}

IrradianceRange area_range(const PreparedLight& light, const Box& box) {
    const AreaEmitter& lamp = *light.area();
    const double scale = light.area_scale();
    const glm::dvec3& z = light.direction();
    const glm::dvec3 to_box = box.center() - light.position();
    const glm::dvec3 half_box = box.half_extent();
    const double middle_height = glm::dot(to_box, z);
    const double height_swing =
        glm::dot(half_box, glm::abs(z)) + rounding * (length(to_box) + length(half_box));
    if (middle_height + height_swing < 0.0) return {0.0, 0.0};

    const double lamp_radius = scale * std::hypot(lamp.half_x(), lamp.half_y());
    const double ball = box.radius() + lamp_radius;
    const double least = min_angle(z, to_box, ball) - rounding;
    if (lamp.spreads() && least >= lamp.half_spread()) return {0.0, 0.0};
    // Heights are held above a minimum (prepared_light.cpp), which moves a point by no more than this.
    const double held = min_light_distance + 2e-9 * scale;
    const glm::dvec3 extent =
        scale * (glm::abs(light.frame()[0]) * lamp.half_x() + glm::abs(light.frame()[1]) * lamp.half_y());
    const double near = std::max(
        0.0, distance_between(box, {light.position() - extent, light.position() + extent}) * (1 - rounding) -
                 held);
    const double far = box.max_distance(light.position()) + lamp_radius + held;

    const double cos_most =
        std::min(1.0, std::max(middle_height + height_swing + held, held) / std::max(near, 1e-300));
    const double gain =
        least > 0.0 ? lamp.gain(std::tan(std::min(least, 0.5 * pi - 1e-9))) : lamp.axis_gain();
    const double sin_spread = std::sin(lamp.half_spread());
    const double radiance = 1.0 / pi / lamp.area() / scale / scale;  // per unit of power
    // All of the sky it may fill, or all of it from the nearest place.
    const double filling = radiance * pi * sin_spread * sin_spread;
    const double nearest = 1.0 / pi / near / near;
    const double integral_error =
        3 * default_area_tolerance * lamp.axis_gain() * std::min(radiance * pi, nearest);
    const double most = std::min(
        gain * filling, gain * std::min(cos_most, std::cos(std::clamp(least, 0.0, 0.5 * pi))) * nearest);

    const double largest = max_angle(z, to_box, ball) + rounding;
    double lowest = 0.0;
    const double middle_distance = box.min_distance(light.position());
    if (largest < 0.5 * pi && middle_distance > lamp_radius && middle_height - height_swing > 0.0) {
        const double cos_receiver =
            std::sqrt(1.0 - (lamp_radius / middle_distance) * (lamp_radius / middle_distance));
        const double cos_least = std::cos(largest);
        lowest = lamp.gain(std::tan(largest)) * cos_least * cos_receiver / pi / far / far - integral_error;
    }
    return {std::max(0.0, lowest), most + integral_error};
}

}  // namespace

double min_angle(const glm::dvec3& axis, const glm::dvec3& middle, double radius) {
    return std::max(0.0, angle_between(axis, middle) - half_angle(length(middle), radius));
}

double max_angle(const glm::dvec3& axis, const glm::dvec3& middle, double radius) {
    return std::min(pi, angle_between(axis, middle) + half_angle(length(middle), radius));
}

IrradianceRange irradiance_range(const PreparedLight& light, const Box& box) {
    if (light.dark()) return {0.0, 0.0};
    if (light.kind() == LightKind::sun) return {1.0, 1.0};
    IrradianceRange range = light.kind() == LightKind::area ? area_range(light, box) : ball_range(light, box);
    range.min *= 1 - rounding;
    range.max *= 1 + rounding;
    return range;
}

NormalCone normal_cone(std::span<const glm::dvec3> normals) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& normal : normals) {
        require_finite("normals", normal);
        if (normal != glm::dvec3(0.0)) mean += unit(normal);
    }
    if (!(length(mean) > 1e-6 * static_cast<double>(normals.size()))) return {};
    NormalCone cone{unit(mean), 0.0};
    for (const glm::dvec3& normal : normals) {
        if (normal != glm::dvec3(0.0))
            cone.half_angle = std::max(cone.half_angle, angle_between(cone.axis, unit(normal)));
    }
    return cone;
}

namespace {

/// Smallest and largest share of its facing irradiance that a lamp gives to any normal of the cone, anywhere
/// in the box.
IrradianceRange cosine_range(const PreparedLight& light, const Box& box, const NormalCone& facing) {
    const glm::dvec3 middle = box.center();
    double swing = facing.half_angle + rounding;
    double radius = 0;  // angular, of the lamp seen from anywhere in the box
    if (light.kind() == LightKind::sun) {
        radius = std::asin(std::min(1.0, light.sin_sun_radius()));
    } else {
        const double extent =
            light.area() ? light.area_scale() * std::hypot(light.area()->half_x(), light.area()->half_y())
                         : light.radius();
        const double nearest = box.min_distance(light.position());
        if (nearest <= extent || nearest <= min_light_distance) return {0.0, 1.0};
        swing += half_angle(light.distance(middle), box.radius());
        radius = std::asin(extent / nearest);
    }
    const double middle_angle = angle_between(facing.axis, light.to_light(middle));
    const double least = std::max(0.0, middle_angle - swing - radius);
    const double largest = std::min(pi, middle_angle + swing + radius);
    // A facing receiver gets at least cos(radius) of what one without a cosine would.
    const double most = std::max(0.0, std::cos(least)) / std::max(std::cos(radius), rounding);
    return {std::max(0.0, std::cos(largest)), std::min(1.0, most)};
}

glm::dvec3 error_within(std::span<const Light> lights, const glm::dvec3& point, const Box& box,
                        const NormalCone* facing) {
    validate(box);
    const glm::dvec3 here = object_irradiance(lights, point);
    CompensatedSumRgb least;
    CompensatedSumRgb most;
    for (const Light& light : lights) {
        if (!is_on(light)) continue;
        const PreparedLight prepared(light);
        IrradianceRange range = irradiance_range(prepared, box);
        if (facing != nullptr) {
            const IrradianceRange share = cosine_range(prepared, box, *facing);
            range = {range.min * share.min * (1 - rounding), range.max * share.max};
        }
        const double first = light.power * range.min;
        const double second = light.power * range.max;
        least.add(light.color * std::min(first, second));  // negative power turns the range over
        most.add(light.color * std::max(first, second));
    }
    const glm::dvec3 error = glm::max(glm::max(most.total() - here, here - least.total()), glm::dvec3(0.0));
    return require_finite("bound of the object weight's error", error);
}

}  // namespace

glm::dvec3 object_irradiance_error(std::span<const Light> lights, const glm::dvec3& point, const Box& box) {
    return error_within(lights, point, box, nullptr);
}

glm::dvec3 object_irradiance_error(std::span<const Light> lights, const glm::dvec3& point, const Box& box,
                                   const NormalCone& facing) {
    return error_within(lights, point, box, &facing);
}

}  // namespace skinglow
