#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string_view>

#include "light/light.h"

/// The fields of a Light as a rig file has them: one row each, which reading and writing share. Not for use
/// outside.
namespace skinglow {

/// Which kinds of lamp have a field.
struct Kinds {
    bool point, sun, spot, area;
    constexpr bool include(LightKind kind) const {
        switch (kind) {
            case LightKind::point:
                return point;
            case LightKind::sun:
                return sun;
            case LightKind::spot:
                return spot;
            case LightKind::area:
                return area;
        }
        return false;
    }
};
constexpr Kinds every_kind{true, true, true, true};
constexpr Kinds ball_kinds{true, false, true, false};

struct VectorField {
    std::string_view key;
    glm::dvec3 Light::*member;
    Kinds kinds;
    bool may_be_negative;
};
constexpr std::array vector_fields = {
    VectorField{"color", &Light::color, every_kind, false},
    VectorField{"position", &Light::position, every_kind, true},
    VectorField{"direction", &Light::direction, every_kind, true},
    VectorField{"tangent", &Light::tangent, {false, false, false, true}, true},
};

struct NumberField {
    std::string_view key;
    double Light::*member;
    Kinds kinds;
    double min;
    double max;
};
constexpr double any_size = std::numeric_limits<double>::max();
constexpr std::array number_fields = {
    NumberField{"power", &Light::power, every_kind, -any_size, any_size},
    NumberField{"radius", &Light::radius, ball_kinds, 0.0, any_size},
    NumberField{"sun_angle", &Light::sun_angle, {false, true, false, false}, 0.0, std::numbers::pi},
    NumberField{"spot_angle", &Light::spot_angle, {false, false, true, false}, 0.0, std::numbers::pi},
    NumberField{"spot_blend", &Light::spot_blend, {false, false, true, false}, 0.0, 1.0},
    NumberField{"size_x", &Light::size_x, {false, false, false, true}, 0.0, any_size},
    NumberField{"size_y", &Light::size_y, {false, false, false, true}, 0.0, any_size},
    NumberField{"spread", &Light::spread, {false, false, false, true}, 0.0, std::numbers::pi},
};

struct SwitchField {
    std::string_view key;
    bool Light::*member;
    Kinds kinds;
};
constexpr std::array switch_fields = {
    SwitchField{"visible", &Light::visible, every_kind},
    SwitchField{"soft_falloff", &Light::soft_falloff, ball_kinds},
    SwitchField{"spot_cosine", &Light::spot_cosine, {false, false, true, false}},
};

}  // namespace skinglow
