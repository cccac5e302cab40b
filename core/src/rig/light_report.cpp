#include <skinglow/light_weights.h>
#include <skinglow/spectrum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

constexpr std::array<std::string_view, 11> state_names = {
    "shines", "hidden",       "zero power",   "black",  "no width", "occluded",
    "culled", "behind light", "outside cone", "behind", "too weak"};

/// Why a light that is on and not left out gives nothing here.
LightState dark_state(const PreparedLight& light, const glm::dvec3& point, bool has_normal) {
    if (light.dark()) return LightState::no_width;
    if (light.kind() == LightKind::area && glm::dot(point - light.position(), light.direction()) < 0.0)
        return LightState::behind_light;
    if (has_normal && light.facing_irradiance(point, default_area_tolerance) > 0.0) return LightState::behind;
    const bool has_cone =
        light.kind() == LightKind::spot || (light.kind() == LightKind::area && light.area()->spreads());
    return has_cone && light.distance(point) < 1e100 ? LightState::outside_cone : LightState::too_weak;
}

LightState switch_state(const Light& light) {
    if (!light.visible()) return LightState::hidden;
    if (light.power() == 0.0) return LightState::zero_power;
    return light.color() == glm::dvec3(0.0) ? LightState::black : LightState::shines;
}

/// For each light whether culling kept it.
std::vector<bool> flags_of(const std::optional<std::vector<std::size_t>>& kept, std::size_t lights) {
    std::vector<bool> flags(lights, !kept);
    for (const std::size_t index : kept.value_or(std::vector<std::size_t>{})) {
        if (index >= lights)
            refuse_argument("kept index", std::to_string(index), "below the number of lights");
        flags[index] = true;
    }
    return flags;
}

}  // namespace

std::string_view to_text(LightState state) {
    return state_names.at(static_cast<std::size_t>(state));
}

std::vector<LightReportEntry> light_report(const PreparedRig& rig, const glm::dvec3& point,
                                           const std::optional<glm::dvec3>& normal,
                                           const std::vector<bool>& occluded,
                                           const std::optional<std::vector<std::size_t>>& kept) {
    require_finite("point", point);
    const std::optional<glm::dvec3> facing = normal ? std::optional(unit_normal(*normal)) : std::nullopt;
    if (!occluded.empty()) require_count("occluded", occluded.size(), rig.size(), "one per light");
    const std::vector<bool> is_kept = flags_of(kept, rig.size());
    std::vector<LightReportEntry> report;
    report.reserve(rig.size());
    CompensatedSum luminances;
    for (const auto& [i, prepared, color, power, shines] : rig.data().prepared) {
        const Light& light = rig.lights()[i];
        const glm::dvec3 to_light = prepared.to_light(point);
        LightReportEntry entry{.index = i,
                               .name = light.name(),
                               .kind = light.kind(),
                               .distance = light_distance(light, point),
                               .axis_angle = 0.0,
                               .normal_angle = std::nullopt,
                               .weight = glm::dvec3(0.0),
                               .share = 0.0,
                               .state = switch_state(light)};
        if (light.kind() == LightKind::spot || light.kind() == LightKind::area)
            entry.axis_angle = angle_between(prepared.direction(), -to_light);
        if (facing) entry.normal_angle = angle_between(*facing, to_light);
        if (entry.state == LightState::shines && !occluded.empty() && occluded[i])
            entry.state = LightState::occluded;
        if (entry.state == LightState::shines && !is_kept[i]) entry.state = LightState::culled;
        if (entry.state == LightState::shines) {
            const double per_power = facing ? prepared.irradiance(point, *facing, default_area_tolerance)
                                            : prepared.facing_irradiance(point, default_area_tolerance);
            entry.weight =
                require_finite("irradiance of light \"" + light.name() + "\"", color * (power * per_power));
            if (entry.weight == glm::dvec3(0.0))
                entry.state = dark_state(prepared, point, facing.has_value());
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
