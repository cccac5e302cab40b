#include "rig/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace detail {
namespace {

using std::numbers::pi;
/// Rounding of the values and of the bounds themselves, far above what either amounts to.
constexpr double rounding = 1e-9;

/// Half the angle under which a ball is seen; pi from within.
double half_angle(double distance, double radius) {
    return distance > radius ? std::asin(radius / distance) : pi;
}

/// A spot's profile seen from the box: the light's own radius blurs it by as much as the light is wide.
IrradianceRange spot_range(const PreparedLight& light, const Box& box) {
    const double nearest = box.min_distance(light.position());
    // A receiver at the light's position is on its axis, wherever the rest of the box is.
    if (nearest == 0.0) return {0.0, 1.0};
    const glm::dvec3 to_box = box.center() - light.position();
    const double blur = std::asin(std::min(1.0, light.ball_term(nearest).sin_radius));
    const double smallest = min_angle(light.direction(), to_box, box.radius()) - blur;
    const double largest = max_angle(light.direction(), to_box, box.radius()) + blur;
    return {light.spot()->at(std::cos(std::min(largest, pi))),
            light.spot()->at(std::cos(std::max(smallest, 0.0)))};
}

IrradianceRange ball_range(const PreparedLight& light, const Box& box) {
    const double nearest = box.min_distance(light.position());
    IrradianceRange range{light.ball_term(box.max_distance(light.position())).facing,
                          light.ball_term(nearest).facing};
    if (light.kind() != LightKind::spot) return range;
    const IrradianceRange spot = spot_range(light, box);
    // Where the light fills more than the half sky, a facing surface is no measure of its profile.
    return {light.radius() < nearest ? range.min * spot.min : 0.0, range.max * spot.max};
}

IrradianceRange area_range(const PreparedLight& light, const Box& box) {
    const AreaEmitter& area = *light.area();
    const double scale = light.area_scale();
    const glm::dvec3& z = light.direction();
    const glm::dvec3 to_box = box.center() - light.position();
    const glm::dvec3 half_box = box.half_extent();
    const double height = glm::dot(to_box, z);
    const double height_extent =
        glm::dot(half_box, glm::abs(z)) + rounding * (length(to_box) + length(half_box));
    if (height + height_extent < 0.0) return {0.0, 0.0};

    // Heights are clamped above a minimum (prepared_light.cpp), which moves a point by no more than this.
    const double clamping = min_light_distance + 2e-9 * scale;
    const double light_radius = light.radius();
    const double ball = box.radius() + light_radius + clamping;
    const double min_emitter = std::max(0.0, min_angle(z, to_box, ball) - rounding);
    if (area.spreads() && min_emitter >= area.half_spread()) return {0.0, 0.0};
    const glm::dvec3 half_light = half_extent(light);
    const double near =
        std::max(0.0, distance_between(box, {light.position() - half_light, light.position() + half_light}) *
                              (1 - rounding) -
                          clamping);
    const double far = box.max_distance(light.position()) + light_radius + clamping;

    const double max_cos =
        std::min(1.0, std::max(height + height_extent + clamping, clamping) / std::max(near, 1e-300));
    const double gain =
        min_emitter > 0.0 ? area.gain(std::tan(std::min(min_emitter, 0.5 * pi - 1e-9))) : area.axis_gain();
    const double sin_spread = std::sin(area.half_spread());
    const double radiance = 1.0 / pi / area.area() / scale / scale;  // per unit of power
    // All of the sky it may fill, or all of it from the nearest point.
    const double filling = radiance * pi * sin_spread * sin_spread;
    const double nearest = 1.0 / pi / near / near;
    const double integral_error =
        3 * default_area_tolerance * area.axis_gain() * std::min(radiance * pi, nearest);
    const double max =
        gain * std::min(filling, std::min(max_cos, std::cos(std::min(min_emitter, 0.5 * pi))) * nearest);

    const double max_emitter = max_angle(z, to_box, ball) + rounding;
    double min = 0.0;
    const double center_distance = box.min_distance(light.position());
    if (max_emitter < 0.5 * pi && center_distance > light_radius && height - height_extent > 0.0) {
        const double sine = light_radius / center_distance;
        min = area.gain(std::tan(max_emitter)) * std::cos(max_emitter) * std::sqrt(1.0 - sine * sine) / pi /
                  far / far -
              integral_error;
    }
    return {std::max(0.0, min), max + integral_error};
}

/// Smallest and largest fraction of its facing irradiance that a light gives to any normal of the cone,
/// anywhere in the box.
IrradianceRange cosine_range(const PreparedLight& light, const Box& box, const NormalCone& normals) {
    double spread = normals.half_angle + rounding;
    double radius = 0;  // angular, of the light seen from anywhere in the box
    if (light.kind() == LightKind::sun) {
        radius = std::asin(std::min(1.0, light.sin_sun_radius()));
    } else {
        const double extent = light.radius();
        const double nearest = box.min_distance(light.position());
        if (nearest <= extent || nearest <= min_light_distance) return {0.0, 1.0};
        spread += half_angle(light.distance(box.center()), box.radius());
        radius = std::asin(extent / nearest);
    }
    const double center_angle = angle_between(normals.axis, light.to_light(box.center()));
    const double smallest = std::max(0.0, center_angle - spread - radius);
    const double largest = std::min(pi, center_angle + spread + radius);
    // A facing receiver gets at least cos(radius) of what one without a cosine would.
    const double max = std::max(0.0, std::cos(smallest)) / std::max(std::cos(radius), rounding);
    return {std::max(0.0, std::cos(largest)), std::min(1.0, max)};
}

}  // namespace

double min_angle(const glm::dvec3& axis, const glm::dvec3& center, double radius) {
    return std::max(0.0, angle_between(axis, center) - half_angle(length(center), radius));
}

double max_angle(const glm::dvec3& axis, const glm::dvec3& center, double radius) {
    return std::min(pi, angle_between(axis, center) + half_angle(length(center), radius));
}

double distance_between(const Box& a, const Box& b) {
    return length(glm::max(glm::max(a.min - b.max, b.min - a.max), glm::dvec3(0.0)));
}

glm::dvec3 half_extent(const PreparedLight& light) {
    const AreaEmitter& area = *light.area();
    return light.area_scale() *
           (glm::abs(light.frame()[0]) * area.half_x() + glm::abs(light.frame()[1]) * area.half_y());
}

IrradianceRange irradiance_range(const PreparedLight& light, const Box& box) {
    if (light.dark()) return {0.0, 0.0};
    if (light.kind() == LightKind::sun) return {1.0, 1.0};
    const IrradianceRange range =
        light.kind() == LightKind::area ? area_range(light, box) : ball_range(light, box);
    return {range.min * (1 - rounding), range.max * (1 + rounding)};
}

}  // namespace detail

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

glm::dvec3 object_irradiance_error(const PreparedRig& rig, const glm::dvec3& point, const Box& box,
                                   const std::optional<NormalCone>& normals) {
    validate(box);
    const glm::dvec3 here = object_irradiance(rig, point);
    CompensatedSumRgb min;
    CompensatedSumRgb max;
    for (const RigLight& one : rig.data().prepared) {
        if (!one.shines) continue;
        IrradianceRange range = irradiance_range(one.light, box);
        if (normals) {
            const IrradianceRange cosine = cosine_range(one.light, box, *normals);
            range = {range.min * cosine.min * (1 - rounding), range.max * cosine.max};
        }
        // Negative power swaps the ends.
        min.add(glm::min(one.scaled(range.min), one.scaled(range.max)));
        max.add(glm::max(one.scaled(range.min), one.scaled(range.max)));
    }
    const glm::dvec3 error = glm::max(glm::max(max.total() - here, here - min.total()), glm::dvec3(0.0));
    return require_finite("bound of the object weight's error", error);
}

}  // namespace skinglow
