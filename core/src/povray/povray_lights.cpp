#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"
#include "radiometry/prepared_light.h"

namespace skinglow::detail {
namespace {

constexpr double pi = std::numbers::pi;
/// Above this spread, radians, the tangent has no bound, and there is no edge.
constexpr double lambert_spread = 0.9999 * pi;

double degrees(double radians) {
    return radians * 180.0 / pi;
}

/// A step from a position that rounding does not lose.
double visible_step(const glm::dvec3& position, double step) {
    return std::max(step, 1e-6 * max_abs(position));
}

void add_point_at(SdlText& text, const PreparedLight& light) {
    const double step = visible_step(light.position(), 1.0);
    text.add("\n  spotlight point_at ", light.position() + step * light.direction());
}

/// Blender's inverse square in POV-Ray: attenuation is 2 / (1 + (d / f)^2), so 1 / (2 f^2) of the light makes
/// 1 / (f^2 + d^2). f is a soft ball's radius, which has that very law, else so small that it does not show.
double fade_distance(const PreparedLight& light, const Box& bounds) {
    constexpr double min_fade = 1e-4 * min_light_distance;
    const bool is_ball = !light.area() && light.soft_falloff() && light.radius() > 0.0;
    if (is_ball) return std::max(light.radius(), min_fade);
    const double size = 2.0 * bounds.radius();
    return std::max(1e-4 * std::max(bounds.min_distance(light.position()), 1e-3 * size), min_fade);
}

/// "rgb <...>", refused by the light's name where it is beyond the largest double.
void add_color(SdlText& text, const Light& light, double factor) {
    text.add("\n  rgb ", require_finite("light \"" + light.name() + "\" intensity", light.color() * factor));
}

void add_fading_color(SdlText& text, const Light& light, double power_to_intensity, const Box& bounds) {
    const double f = fade_distance(PreparedLight(light), bounds);
    // One factor after the other, so that no square over- or underflows.
    add_color(text, light, light.power() / f * power_to_intensity / (2.0 * f));
    text.add("\n  fade_distance ", f, " fade_power 2");
}

/// POV-Ray's cone fades by the same smoothstep in the cosine as Blender's.
void add_spot(SdlText& text, const SpotLight& light, const PreparedLight& prepared) {
    const double cos_edge = std::cos(0.5 * light.spot_angle);
    const double cos_fade = cos_edge + light.spot_blend * (1.0 - cos_edge);
    add_point_at(text, prepared);
    text.add(" radius ", degrees(std::acos(std::clamp(cos_fade, -1.0, 1.0))), " falloff ",
             degrees(0.5 * light.spot_angle), " tightness ", light.spot_cosine ? 1.0 : 0.0);
}

/// A spread fades from its axis on by Blender's (tan h - tan t) / tan h, which is not among POV-Ray's laws: a
/// smoothstep in the cosine, times the cosine to a power, is made to agree on the axis, at the edge and
/// half-way between them. Written in half angles, because differences of cosines near 1 would cancel.
double spread_tightness(double half_spread) {
    const double sine = std::sin(0.5 * half_spread);
    const double fraction = std::sin(0.75 * half_spread) * std::sin(0.25 * half_spread) / (sine * sine);
    const double smoothstep = fraction * fraction * (3.0 - 2.0 * fraction);
    const double tangent = std::tan(0.5 * half_spread);
    const double wanted = 0.5 * (1.0 + tangent * tangent);
    const double log_cosine = 0.5 * std::log1p(-sine * sine);
    return 1.0 + std::log(wanted / smoothstep) / log_cosine;
}

void add_area(SdlText& text, const AreaLight& light, const PreparedLight& prepared) {
    // A Lambert emitter's cosine is a cone of half a turn with tightness 1 and a hard edge.
    const bool lambert = light.spread > lambert_spread;
    const double half_spread = prepared.area()->half_spread();
    const double falloff = degrees(half_spread);
    add_point_at(text, prepared);
    text.add(" radius ", lambert ? falloff : 0.0, " falloff ", falloff, " tightness ",
             lambert ? 1.0 : spread_tightness(half_spread));
    // POV-Ray's outermost samples lie on the edge: nine of them over sqrt(8/10) of the width have the variance of
    // the whole width.
    const double inner = std::sqrt(0.8);
    text.add("\n  area_light ", inner * light.size_x * prepared.frame()[0], ", ",
             inner * light.size_y * prepared.frame()[1], ", 9, 9 adaptive 1 area_illumination on");
    if (light.area_shape == AreaShape::ellipse) text.add(" circular");
}

void add_sun(SdlText& text, const Light& light, const PreparedLight& prepared, const Box& bounds) {
    const glm::dvec3 center = bounds.center();
    const double distance = visible_step(center, 2.0 * std::max(2.0 * bounds.radius(), 1.0));
    text.add(center - distance * prepared.direction());
    add_color(text, light, light.power() / pi);
    text.add("\n  parallel point_at ", center);
}

}  // namespace

std::string povray_lights_text(const std::vector<Light>& lights_on, const Box& bounds) {
    SdlText text;
    text.add("// Blender's watts: POV-Ray's diffuse has no 1/pi, so a light is its irradiance / pi.\n");
    for (const Light& light : lights_on) {
        const PreparedLight prepared(light);
        if (prepared.dark()) continue;
        text.add("// " + sdl_comment(light.name()) + " (", to_text(light.kind()), ")\nlight_source {\n  ");
        if (light.kind() == LightKind::sun) {
            add_sun(text, light, prepared, bounds);
        } else if (const auto* area = std::get_if<AreaLight>(&light.shape())) {
            text.add(light.position());
            const double gain = area->spread > lambert_spread ? 1.0 : prepared.area()->axis_gain();
            add_fading_color(text, light, gain / (pi * pi), bounds);
            add_area(text, *area, prepared);
        } else {
            text.add(light.position());
            add_fading_color(text, light, 1.0 / (4.0 * pi * pi), bounds);
            if (const auto* spot = std::get_if<SpotLight>(&light.shape())) add_spot(text, *spot, prepared);
        }
        text.add("\n}\n");
    }
    return text.take();
}

}  // namespace skinglow::detail
