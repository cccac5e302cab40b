#include <algorithm>

#include "geometry/vector.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"
#include "radiometry/prepared_light.h"

namespace skinglow::detail {
namespace {

void add_shape(SdlText& text, const PointLight& light) {
    text.add("Skinglow_Point_Shape(", light.radius, ", ", light.soft_falloff ? 1 : 0, ")");
}

void add_shape(SdlText& text, const SunLight& light) {
    text.add("Skinglow_Sun_Shape(", light.sun_angle, ")");
}

void add_shape(SdlText& text, const SpotLight& light) {
    text.add("Skinglow_Spot_Shape(", light.radius, ", ", light.soft_falloff ? 1 : 0, ", ", light.spot_angle,
             ", ", light.spot_blend, ", ", light.spot_cosine ? 1 : 0, ")");
}

void add_shape(SdlText& text, const AreaLight& light) {
    text.add(light.area_shape == AreaShape::ellipse ? "Skinglow_Ellipse_Shape(" : "Skinglow_Rectangle_Shape(",
             light.size_x, ", ", light.size_y, ", ", light.tangent, ", ", light.spread, ")");
}

/// Outside of the scene, on the sun's side: POV-Ray's parallel rays come from there.
glm::dvec3 sun_position(const PreparedLight& sun, const Box& bounds) {
    const glm::dvec3 center = bounds.center();
    const double distance =
        std::max(2.0 * std::max(2.0 * bounds.radius(), 1.0), 1e-6 * max_abs(center));  // not lost by rounding
    return center - distance * sun.direction();
}

}  // namespace

std::string povray_lights_text(const std::vector<Light>& lights_on, const Box& bounds) {
    SdlText text;
    text.add("// Each light makes its light_source, and the glow is computed of what is written here.\n");
    text.add(
        "// kind, color, position, direction, power (W; of a sun W/m^2), shape: skinglow.inc says more\n");
    for (const Light& light : lights_on) {
        const PreparedLight prepared(light);
        const bool is_sun = light.kind() == LightKind::sun;
        text.add("// ", sdl_comment(light.name()), "\nSkinglow_Light(\"", to_text(light.kind()), "\", ",
                 light.color(), ", ", is_sun ? sun_position(prepared, bounds) : light.position(), ", ",
                 light.kind() == LightKind::point ? light.direction() : prepared.direction(), ", ",
                 light.power(), ",\n    ");
        std::visit([&](const auto& shape) { add_shape(text, shape); }, light.shape());
        text.add(")\n");
    }
    return text.take();
}

}  // namespace skinglow::detail
