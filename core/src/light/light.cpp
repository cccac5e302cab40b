#include "light/light.h"

#include <array>
#include <numbers>
#include <utility>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

using NamedKind = std::pair<LightKind, std::string_view>;
constexpr std::array<NamedKind, 4> kinds = {
    NamedKind{LightKind::point, "POINT"}, NamedKind{LightKind::sun, "SUN"},
    NamedKind{LightKind::spot, "SPOT"}, NamedKind{LightKind::area, "AREA"}};

void require_between(const std::string& name, double value, double least, double most,
                     std::string_view allowed) {
    // Written so that NaN is refused too.
    if (!(value >= least && value <= most)) refuse_argument(name, to_text(value), allowed);
}

void validate_shape(const Light& light, const std::string& who) {
    // A host's single-precision pi is a little above pi.
    constexpr double pi = std::numbers::pi_v<float>;
    constexpr std::string_view half_turn = "an angle of 0 to pi radians";
    switch (light.kind) {
        case LightKind::point:
            require_not_negative(who + "radius", light.radius);
            break;
        case LightKind::sun:
            require_between(who + "sun_angle", light.sun_angle, 0.0, pi, half_turn);
            break;
        case LightKind::spot:
            require_not_negative(who + "radius", light.radius);
            require_between(who + "spot_angle", light.spot_angle, 0.0, pi, half_turn);
            require_between(who + "spot_blend", light.spot_blend, 0.0, 1.0, "a number of 0 to 1");
            break;
        case LightKind::area:
            require_not_negative(who + "size_x", light.size_x);
            require_not_negative(who + "size_y", light.size_y);
            require_finite(who + "tangent", light.tangent);
            require_between(who + "spread", light.spread, 0.0, pi, half_turn);
            break;
    }
}

}  // namespace

std::string_view to_text(AreaShape shape) {
    return shape == AreaShape::rectangle ? "RECTANGLE" : "ELLIPSE";
}

AreaShape area_shape(std::string_view name) {
    if (name == "RECTANGLE" || name == "SQUARE") return AreaShape::rectangle;
    if (name == "ELLIPSE" || name == "DISK") return AreaShape::ellipse;
    refuse_argument("area shape", "\"" + std::string(name) + "\"", "RECTANGLE, SQUARE, ELLIPSE or DISK");
}

std::string_view to_text(LightKind kind) {
    for (const auto& [known, name] : kinds) {
        if (known == kind) return name;
    }
    refuse_argument("light kind", std::to_string(static_cast<int>(kind)), "POINT, SUN, SPOT or AREA");
}

LightKind light_kind(std::string_view name) {
    for (const auto& [kind, known] : kinds) {
        if (known == name) return kind;
    }
    refuse_argument("light kind", "\"" + std::string(name) + "\"", "POINT, SUN, SPOT or AREA");
}

void validate(const Light& light) {
    const std::string who = light.name.empty() ? "light " : "light \"" + light.name + "\" ";
    require_not_negative(who + "color", light.color);
    require_finite(who + "position", light.position);
    require_finite(who + "direction", light.direction);
    require_finite(who + "power", light.power);
    if (light.kind != LightKind::point && light.direction == glm::dvec3(0.0)) {
        refuse_argument(who + "direction", to_text(light.direction), "a vector of length above 0");
    }
    validate_shape(light, who);
}

bool is_on(const Light& light) {
    return light.visible && light.power != 0.0 && light.color != glm::dvec3(0.0);
}

}  // namespace skinglow
