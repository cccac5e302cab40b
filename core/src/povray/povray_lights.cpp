#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;

double degrees(double radians) {
    return radians * 180.0 / pi;
}

/// Blender's inverse square in POV-Ray: attenuation is 2 / (1 + (d / f)^2), so 1 / (2 f^2) of the light makes
/// 1 / (f^2 + d^2). f is a soft ball's radius, which has that very law, else so small that it does not show.
double fade_distance(const Light& light, const PovrayBounds& bounds) {
    const bool has_disk = light.kind == LightKind::point || light.kind == LightKind::spot;
    if (has_disk && light.soft_falloff && light.radius > 0.0) return light.radius;
    const glm::dvec3 nearest = glm::clamp(light.position, bounds.low, bounds.high);
    const double size = std::max(bounds.diagonal(), 1e-100);
    return 1e-4 * std::max(glm::length(light.position - nearest), 1e-3 * size);
}

void add_fading_color(SdlText& text, const Light& light, double power_to_intensity,
                      const PovrayBounds& bounds) {
    const double f = fade_distance(light, bounds);
    text.add("\n  rgb ").add(light.color * (light.power * power_to_intensity / (2.0 * f * f)));
    text.add("\n  fade_distance ").add(f).add(" fade_power 2");
}

/// POV-Ray's cone fades by the same smoothstep in the cosine as Blender's.
void add_spot(SdlText& text, const Light& light) {
    const double cos_edge = std::cos(0.5 * light.spot_angle);
    const double cos_fade = cos_edge + light.spot_blend * (1.0 - cos_edge);
    text.add("\n  spotlight point_at ").add(light.position + glm::normalize(light.direction));
    text.add(" radius ").add(degrees(std::acos(std::clamp(cos_fade, -1.0, 1.0))));
    text.add(" falloff ").add(degrees(0.5 * light.spot_angle));
    text.add(" tightness ").add(light.spot_cosine ? 1.0 : 0.0);
}

/// Half a turn: the tangent has no bound, and there is no edge.
bool is_lambert(double spread) {
    return spread > 0.9999 * pi;
}

/// A spread fades from its axis on by Blender's (tan h - tan t) / tan h, which is not among POV-Ray's laws: a
/// smoothstep in the cosine, times the cosine to a power, is made to agree on the axis, at the edge and
/// half-way between them.
double spread_tightness(double spread) {
    const double half = 0.5 * spread;
    const double cos_middle = std::cos(0.5 * half);
    const double share = (cos_middle - std::cos(half)) / (1.0 - std::cos(half));
    const double wanted = 1.0 - std::tan(0.5 * half) / std::tan(half);
    return 1.0 + std::log(wanted / (share * share * (3.0 - 2.0 * share))) / std::log(cos_middle);
}

void add_area(SdlText& text, const Light& light) {
    const glm::dvec3 facing = glm::normalize(light.direction);
    glm::dvec3 x = light.tangent - glm::dot(light.tangent, facing) * facing;
    if (!(glm::length(x) > 1e-9 * glm::length(light.tangent))) {
        const glm::dvec3 other = std::abs(facing.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        x = glm::cross(other, facing);
    }
    x = glm::normalize(x);
    // A Lambert emitter's cosine is a cone of half a turn with tightness 1 and a hard edge.
    const double falloff = degrees(0.5 * light.spread);
    const bool lambert = is_lambert(light.spread);
    text.add("\n  spotlight point_at ")
        .add(light.position + facing)
        .add(" radius ")
        .add(lambert ? falloff : 0.0);
    text.add(" falloff ").add(falloff).add(" tightness ").add(lambert ? 1.0 : spread_tightness(light.spread));
    if (light.size_x > 0.0 || light.size_y > 0.0) {
        // POV-Ray's samples reach the rim: nine of them over sqrt(8/10) of the width spread as the whole
        // width does.
        const double inner = std::sqrt(0.8);
        text.add("\n  area_light ").add(inner * light.size_x * x).add(", ");
        text.add(inner * light.size_y * glm::cross(facing, x)).add(", 9, 9 adaptive 1 area_illumination on");
        if (light.area_shape == AreaShape::ellipse) text.add(" circular");
    }
}

/// A cone or spread of no angle gives no light.
bool is_shut(const Light& light) {
    return (light.kind == LightKind::spot && !(light.spot_angle > 0.0)) ||
           (light.kind == LightKind::area && !(light.spread > 0.0));
}

double spread_gain(double spread) {
    const double half = 0.5 * spread;
    return is_lambert(spread) ? 1.0 : std::tan(half) / (std::tan(half) - half);
}

}  // namespace

std::string povray_lights_text(const std::vector<Light>& lights_on, const PovrayBounds& bounds) {
    SdlText text;
    text.add("// Blender's watts: POV-Ray's diffuse has no 1/pi, so a light is its irradiance / pi.\n");
    for (const Light& light : lights_on) {
        if (is_shut(light)) continue;
        text.add("// " + sdl_comment(light.name) + " (")
            .add(to_text(light.kind))
            .add(")\nlight_source {\n  ");
        if (light.kind == LightKind::sun) {
            const glm::dvec3 towards = glm::normalize(light.direction);
            const double away = 2.0 * std::max(bounds.diagonal(), 1.0);
            text.add(bounds.center() - away * towards).add("\n  rgb ").add(light.color * (light.power / pi));
            text.add("\n  parallel point_at ").add(bounds.center());
        } else if (light.kind == LightKind::area) {
            text.add(light.position);
            add_fading_color(text, light, spread_gain(light.spread) / (pi * pi), bounds);
            add_area(text, light);
        } else {
            text.add(light.position);
            add_fading_color(text, light, 1.0 / (4.0 * pi * pi), bounds);
            if (light.kind == LightKind::spot) add_spot(text, light);
        }
        text.add("\n}\n");
    }
    return text.take();
}

}  // namespace skinglow
