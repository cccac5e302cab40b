#include <skinglow/light.h>
#include <skinglow/spectrum.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <type_traits>
#include <utility>

#include "geometry/rigid_motion.h"
#include "light/light_fields.h"
#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// In the order of LightKind.
constexpr std::array<std::string_view, 4> kind_names = {"POINT", "SUN", "SPOT", "AREA"};

bool within(double value, const Limits& limits) {
    return value >= limits.min && value <= limits.max;  // NaN is not
}
bool within(const glm::dvec3& value, const Limits& limits) {
    return within(value.x, limits) && within(value.y, limits) && within(value.z, limits);
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
        const Limits range = limits(field.range);
        if constexpr (requires { within(value, range); }) {
            const bool is_number = std::is_same_v<std::decay_t<decltype(value)>, double>;
            if (!within(value, range))
                refuse_argument(named(field.key), to_text(value),
                                is_number ? range.allowed : range.allowed_vector);
        }
    });
    if (kind() != LightKind::point && direction() == glm::dvec3(0.0))
        refuse_argument(named("direction"), to_text(direction()), "a vector of length above 0");
}

Light Light::moved(const glm::dmat4& motion) const {
    const RigidMotion rigid("motion", motion);
    LightSettings settings = settings_;
    settings.position = rigid.point(position());
    settings.direction = rigid.direction(direction());
    if (auto* area = std::get_if<AreaLight>(&settings.shape)) area->tangent = rigid.direction(area->tangent);
    return settings;
}

bool is_on(const Light& light) {
    return light.visible() && light.power() != 0.0 && light.color() != glm::dvec3(0.0);
}

double legacy_sun_power_factor(double angle) {
    if (!(angle >= 0 && angle < std::numbers::pi))
        refuse_argument("angle", to_text(angle), "0 to below pi radians");
    const double cosine = std::cos(0.5 * angle);
    return 2 * cosine / (1 + cosine);
}

double exposure_factor(double stops) {
    require_finite("exposure", stops);
    return require_finite("2^exposure", std::exp2(stops));
}

double unnormalized_power_factor(const Light& light) {
    using std::numbers::pi;
    const auto factor = [](const auto& shape) {
        if constexpr (requires { shape.radius; }) {
            return 4 * pi * shape.radius * shape.radius;
        } else if constexpr (requires { shape.sun_angle; }) {
            return pi * std::sin(0.5 * shape.sun_angle) * std::sin(0.5 * shape.sun_angle);
        } else {
            return shape.size_x * shape.size_y * (shape.area_shape == AreaShape::ellipse ? pi / 4 : 1.0);
        }
    };
    return std::visit(factor, light.shape());
}

glm::dvec3 black_body_color(double kelvin) {
    require_between("temperature", kelvin, 800, 20000, " K");
    return glm::max(spectral_color(blackbody_spectrum(kelvin)), 0.0);
}

}  // namespace skinglow
