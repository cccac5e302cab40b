#pragma once

#include <glm/vec3.hpp>
#include <numbers>
#include <string>
#include <string_view>

namespace skinglow {

enum class LightKind { point, sun, spot, area };

/// Blender's square and rectangle are `rectangle`, its disk and ellipse `ellipse`.
enum class AreaShape { rectangle, ellipse };

/// "POINT", "SUN", "SPOT" or "AREA", as Blender spells them.
std::string_view to_text(LightKind kind);
/// The kind of that name; throws std::invalid_argument on any other.
LightKind light_kind(std::string_view name);

/// "RECTANGLE" or "ELLIPSE".
std::string_view to_text(AreaShape shape);
/// The shape of that name; "SQUARE" and "DISK" are read as the general forms. Throws std::invalid_argument on
/// any other.
AreaShape area_shape(std::string_view name);

/// A lamp as a scene has it. World units of its positions are the scene's: Eq. 2 of the paper has no unit of
/// its own, and for irradiance one unit of length is one meter, as in Blender, whatever its unit scale says.
///
/// A reader of a host's lamps folds into `color` what tints (node color, black body), and into `power` what
/// scales: node strength, exposure, lamps that are not normalized, a host version's own factor. light_units.h
/// has these numbers. What cannot be folded is a field here: `soft_falloff`, `spot_cosine`.
struct Light {
    LightKind kind = LightKind::point;
    glm::dvec3 color{1.0};                 ///< linear Rec.709, each 0 or more
    glm::dvec3 position{0.0};              ///< world; a sun has none that matters
    glm::dvec3 direction{0.0, 0.0, -1.0};  ///< where it shines to; any length but 0 for sun, spot and area
    double power = 1.0;   ///< W; for a sun W/m^2, as Blender has it. Mode `paper` asks only whether it is 0.
    std::string name;     ///< for reports
    bool visible = true;  ///< false: off, left out of every sum

    /// Point and spot: radius of the glowing ball, scene unit, 0 or more.
    double radius = 0.0;
    /// Point and spot: true, a disk that always faces the lit point (Blender's default, and all there was
    /// before 4.1); false, a ball.
    bool soft_falloff = true;
    /// Sun: full angle it is seen under, radians, 0 to pi.
    double sun_angle = 0.0;
    /// Spot: full angle of the cone, radians, 0 (no light) to pi.
    double spot_angle = std::numbers::pi / 4;
    /// Spot: share of the cone that fades, 0 (hard edge) to 1.
    double spot_blend = 0.15;
    /// Spot: also times the cosine to its axis, as Blender 3.4 has it and 4.5 and later have not.
    bool spot_cosine = false;
    AreaShape area_shape = AreaShape::rectangle;
    /// Area: full width along and across `tangent`, scene unit, 0 or more; both 0: a small lamp.
    double size_x = 0.0;
    double size_y = 0.0;
    /// Area: world direction of size_x, made perpendicular to `direction`; parallel to it, or 0: any
    /// perpendicular.
    glm::dvec3 tangent{1.0, 0.0, 0.0};
    /// Area: full angle it shines into, radians, 0 (no light) to pi (Lambert emitter).
    double spread = std::numbers::pi;
};

/// Throws std::invalid_argument, naming light, field, value and what is allowed, on non-finite or negative
/// color, non-finite position, direction, tangent or power, a direction of length 0 where the kind needs
/// one, a negative size or radius, an angle or blend out of range (single-precision pi counts as pi). Sizes
/// and angles are checked for the kinds that have them. Negative power is allowed, as in Blender, where such
/// a lamp takes light away; mode `paper` does not look at its sign.
void validate(const Light& light);

/// False for a lamp that gives nothing: hidden, power 0 or black. Such a lamp is left out, as if it were not
/// there.
bool is_on(const Light& light);

}  // namespace skinglow
