#include <skinglow/light.h>

#include <array>
#include <utility>

#include "light/light_fields.h"
#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// In the order of LightKind.
constexpr std::array<std::string_view, 4> kind_names = {"POINT", "SUN", "SPOT", "AREA"};

bool within(double value, FieldRange range) {
    return value >= limits(range).min && value <= limits(range).max;  // NaN is not
}
bool within(const glm::dvec3& value, FieldRange range) {
    return within(value.x, range) && within(value.y, range) && within(value.z, range);
}

std::string allowed(double /*value*/, FieldRange range) {
    switch (range) {
        case FieldRange::any:
            return "a finite number";
        case FieldRange::not_negative:
            return "a finite number, 0 or more";
        case FieldRange::fraction:
            return "a number of 0 to 1";
        case FieldRange::half_turn:
            return "an angle of 0 to pi radians";
    }
    return {};
}
std::string allowed(const glm::dvec3& /*value*/, FieldRange range) {
    return range == FieldRange::any ? "three finite numbers" : "three finite numbers, 0 or more";
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
    return kind_names.at(static_cast<std::size_t>(kind));
}

LightKind light_kind(std::string_view name) {
    for (std::size_t i = 0; i < kind_names.size(); ++i) {
        if (kind_names[i] == name) return static_cast<LightKind>(i);
    }
    refuse_argument("light kind", "\"" + std::string(name) + "\"", "POINT, SUN, SPOT or AREA");
}

Light::Light(LightSettings settings) : settings_(std::move(settings)) {
    const auto named = [&](std::string_view key) {
        return (name().empty() ? "light " : "light \"" + name() + "\" ") + std::string(key);
    };
    for_each_field(settings_, [&](const auto& field, const auto& owner) {
        const auto& value = owner.*field.member;
        if constexpr (requires { within(value, field.range); }) {
            if (!within(value, field.range))
                refuse_argument(named(field.key), to_text(value), allowed(value, field.range));
        }
    });
    if (kind() != LightKind::point && direction() == glm::dvec3(0.0))
        refuse_argument(named("direction"), to_text(direction()), "a vector of length above 0");
}

bool is_on(const Light& light) {
    return light.visible() && light.power() != 0.0 && light.color() != glm::dvec3(0.0);
}

namespace detail {

LightShape default_shape(LightKind kind) {
    switch (kind) {
        case LightKind::point:
            return PointLight{};
        case LightKind::sun:
            return SunLight{};
        case LightKind::spot:
            return SpotLight{};
        case LightKind::area:
            return AreaLight{};
    }
    return {};
}

}  // namespace detail
}  // namespace skinglow
