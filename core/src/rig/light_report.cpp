#include "rig/light_report.h"

#include <skinglow/spectrum.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geometry/vector.h"
#include "light/light_weights.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "radiometry/prepared_light.h"
#include "rig/irradiance.h"

namespace skinglow {
namespace {

/// Why a lamp that is on and not left out gives nothing here.
LightState dark_state(const PreparedLight& light, const glm::dvec3& point,
                      const std::optional<glm::dvec3>& normal) {
    if (light.dark()) return LightState::no_width;
    if (light.kind() == LightKind::area && glm::dot(point - light.position(), light.direction()) < 0.0) {
        return LightState::behind_lamp;
    }
    if (normal && light.facing_irradiance(point, default_area_tolerance) > 0.0) return LightState::behind;
    const bool has_cone =
        light.kind() == LightKind::spot || (light.kind() == LightKind::area && light.area()->spreads());
    return has_cone && light.distance(point) < 1e100 ? LightState::outside_cone : LightState::too_weak;
}

LightState switch_state(const Light& light) {
    if (!light.visible) return LightState::hidden;
    if (light.power == 0.0) return LightState::zero_power;
    return light.color == glm::dvec3(0.0) ? LightState::black : LightState::shines;
}

}  // namespace

std::string_view to_text(LightState state) {
    switch (state) {
        case LightState::shines:
            return "shines";
        case LightState::hidden:
            return "hidden";
        case LightState::zero_power:
            return "zero power";
        case LightState::black:
            return "black";
        case LightState::no_width:
            return "no width";
        case LightState::occluded:
            return "occluded";
        case LightState::culled:
            return "culled";
        case LightState::behind_lamp:
            return "behind lamp";
        case LightState::outside_cone:
            return "outside cone";
        case LightState::behind:
            return "behind";
        case LightState::too_weak:
            return "too weak";
    }
    refuse_argument("light state", std::to_string(static_cast<int>(state)), "one of LightState");
}

std::vector<LightReportEntry> light_report(std::span<const Light> lights, const glm::dvec3& point,
                                           const std::optional<glm::dvec3>& normal,
                                           const std::vector<bool>& occluded,
                                           const std::optional<std::vector<std::size_t>>& kept) {
    require_finite("point", point);
    if (normal) require_finite("normal", *normal);
    if (normal && *normal == glm::dvec3(0.0))
        refuse_argument("normal", to_text(*normal), "a vector of length above 0");
    if (!occluded.empty() && occluded.size() != lights.size()) {
        refuse_argument("number of occluded flags", std::to_string(occluded.size()),
                        "one per light (" + std::to_string(lights.size()) + ")");
    }
    const std::optional<glm::dvec3> facing = normal ? std::optional(unit(*normal)) : std::nullopt;
    std::vector<bool> is_kept(lights.size(), !kept);
    if (kept) {
        for (const std::size_t index : *kept) {
            if (index >= lights.size())
                refuse_argument("kept index", std::to_string(index), "below the number of lights");
            is_kept[index] = true;
        }
    }
    std::vector<LightReportEntry> report;
    CompensatedSum luminances;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        validate(light);
        const PreparedLight prepared(light);
        const glm::dvec3 to_light = prepared.to_light(point);
        LightReportEntry entry{.index = i,
                               .name = light.name,
                               .kind = light.kind,
                               .distance = light_distance(light, point),
                               .axis_angle = 0.0,
                               .normal_angle = std::nullopt,
                               .weight = glm::dvec3(0.0),
                               .share = 0.0,
                               .state = switch_state(light)};
        if (light.kind == LightKind::spot || light.kind == LightKind::area) {
            entry.axis_angle = angle_between(prepared.direction(), -to_light);
        }
        if (facing) entry.normal_angle = angle_between(*facing, to_light);
        if (entry.state == LightState::shines && !occluded.empty() && occluded[i])
            entry.state = LightState::occluded;
        if (entry.state == LightState::shines && !is_kept[i]) entry.state = LightState::culled;
        if (entry.state == LightState::shines) {
            entry.weight =
                facing ? irradiance(light, point, *facing) : object_irradiances({&light, 1}, point)[0];
            if (entry.weight == glm::dvec3(0.0)) entry.state = dark_state(prepared, point, facing);
        }
        luminances.add(std::abs(luminance(entry.weight)));
        report.push_back(std::move(entry));
    }
    const double total = luminances.total();
    for (LightReportEntry& entry : report) {
        if (total > 0.0) entry.share = std::min(1.0, std::abs(luminance(entry.weight)) / total);
    }
    return report;
}

}  // namespace skinglow
