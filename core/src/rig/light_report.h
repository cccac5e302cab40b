#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "light/light.h"

namespace skinglow {

/// What a lamp does for a point, or why it does nothing.
enum class LightState {
    shines,
    hidden,  ///< not visible in the scene
    zero_power,
    black,         ///< color (0, 0, 0)
    no_width,      ///< a cone or spread of 0
    occluded,      ///< something stands between
    culled,        ///< left out within the tolerance
    behind_lamp,   ///< the point is behind an area lamp
    outside_cone,  ///< of a spot, or of an area lamp's spread
    behind,        ///< the lamp is below the receiver's horizon
    too_weak,      ///< less than the smallest double
};

/// "shines", "hidden", "zero power", "black", "no width", "occluded", "culled", "behind lamp", "outside
/// cone", "behind", "too weak".
std::string_view to_text(LightState state);

struct LightReportEntry {
    std::size_t index;
    std::string name;
    LightKind kind;
    double distance;    ///< to the middle of the lamp, scene unit; 0 for a sun
    double axis_angle;  ///< between the lamp's axis and the point, radians; 0 for a point lamp and a sun
    std::optional<double>
        normal_angle;   ///< between the receiver's normal and the lamp, radians; none without a normal
    glm::dvec3 weight;  ///< what it brings, W/m^2, linear Rec.709
    double share;       ///< of the luminance of all, by size, 0 to 1; they add up to 1 unless all are 0
    LightState state;
};

/// One entry per lamp, in the order given. Without a normal the weight is the object weight (a surface that
/// faces each lamp), with one it is the irradiance with its cosine.
/// @param occluded  empty, or one per lamp: true, not seen from the point; its weight is 0
/// @param kept      none, or the indices that culling kept: every other lamp's weight is 0
/// Throws std::invalid_argument on bad input, naming it.
std::vector<LightReportEntry> light_report(
    std::span<const Light> lights, const glm::dvec3& point,
    const std::optional<glm::dvec3>& normal = std::nullopt, const std::vector<bool>& occluded = {},
    const std::optional<std::vector<std::size_t>>& kept = std::nullopt);

}  // namespace skinglow
