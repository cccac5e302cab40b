#pragma once

#include <skinglow/light.h>

#include <array>
#include <limits>
#include <numbers>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

#include "numerics/detail.h"

/// The one table of a light's fields: checking, reading, writing, merging and the schema go by it.
namespace skinglow::detail {

/// What a number, or each of a vector's three, may be.
enum class FieldRange { any, not_negative, fraction, half_turn };

struct Limits {
    double min, max;
    std::string_view allowed = {};
    std::string_view allowed_vector = {};
};
constexpr double largest_double = std::numeric_limits<double>::max();
constexpr double half_turn = std::numbers::pi_v<float>;  // a host's single-precision pi is a little above pi
constexpr Limits limits(FieldRange range) {
    constexpr std::array<Limits, 4> table = {{
        {-largest_double, largest_double, "a finite number", "three finite numbers"},
        {0.0, largest_double, "a finite number, 0 or more", "three finite numbers, 0 or more"},
        {0.0, 1.0, "a number of 0 to 1"},
        {0.0, half_turn, "an angle of 0 to pi radians"},
    }};
    return table[static_cast<std::size_t>(range)];
}

template <typename Owner, typename Value>
struct LightField {
    std::string_view key;  ///< in files, and the name in C++ and Python
    Value Owner::*member;
    FieldRange range;
};
template <typename Owner, typename Value>
constexpr LightField<Owner, Value> field(std::string_view key, Value Owner::*member,
                                         FieldRange range = FieldRange::any) {
    return {key, member, range};
}

template <typename Owner>
inline constexpr std::tuple<> fields_of{};
template <>
inline constexpr auto fields_of<LightSettings> = std::tuple{
    field("name", &LightSettings::name),
    field("color", &LightSettings::color, FieldRange::not_negative),
    field("position", &LightSettings::position),
    field("direction", &LightSettings::direction),
    field("power", &LightSettings::power),
    field("visible", &LightSettings::visible),
};
template <>
inline constexpr auto fields_of<PointLight> = std::tuple{
    field("radius", &PointLight::radius, FieldRange::not_negative),
    field("soft_falloff", &PointLight::soft_falloff),
};
template <>
inline constexpr auto fields_of<SunLight> = std::tuple{
    field("sun_angle", &SunLight::sun_angle, FieldRange::half_turn),
};
template <>
inline constexpr auto fields_of<SpotLight> = std::tuple{
    field("radius", &SpotLight::radius, FieldRange::not_negative),
    field("soft_falloff", &SpotLight::soft_falloff),
    field("spot_angle", &SpotLight::spot_angle, FieldRange::half_turn),
    field("spot_blend", &SpotLight::spot_blend, FieldRange::fraction),
    field("spot_cosine", &SpotLight::spot_cosine),
};
template <>
inline constexpr auto fields_of<AreaLight> = std::tuple{
    field("area_shape", &AreaLight::area_shape),
    field("size_x", &AreaLight::size_x, FieldRange::not_negative),
    field("size_y", &AreaLight::size_y, FieldRange::not_negative),
    field("tangent", &AreaLight::tangent),
    field("spread", &AreaLight::spread, FieldRange::half_turn),
};

/// Calls visit(field, owner) for each field of a shape.
template <typename Owner, typename Visit>
void for_each_field_of(Owner& owner, const Visit& visit) {
    std::apply([&](const auto&... fields) { (visit(fields, owner), ...); },
               fields_of<std::remove_const_t<Owner>>);
}

/// Calls visit(field, owner) for each field that a light of its kind has.
template <typename Settings, typename Visit>
void for_each_field(Settings& light, const Visit& visit) {
    for_each_field_of(light, visit);
    std::visit([&](auto& shape) { for_each_field_of(shape, visit); }, light.shape);
}

/// The shape of a kind, every field at its default.
inline LightShape default_shape(LightKind kind) {
    const std::array<LightShape, 4> shapes = {PointLight{}, SunLight{}, SpotLight{}, AreaLight{}};
    return shapes[static_cast<std::size_t>(kind)];
}

}  // namespace skinglow::detail
