#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>

/// What a light is. Lengths are in the scene's unit: Eq. 2 of the paper has no unit of its own, and for
/// irradiance one unit of length is one meter, as in Blender, whatever its unit scale says.
/// @code
/// const skinglow::Light key({.shape = skinglow::SpotLight{.radius = 0.1, .spot_angle = 0.8},
///                            .color = {1.0, 0.44, 0.27}, .position = {0, 0, 2}, .power = 40.0});
/// const double watts = key.power();
/// @endcode
namespace skinglow {

/// In the order of LightShape.
enum class LightKind { point, sun, spot, area };

/// "POINT", "SUN", "SPOT" or "AREA", as Blender spells them.
std::string_view to_text(LightKind kind);
/// The kind of that name; throws std::invalid_argument on any other.
LightKind light_kind(std::string_view name);

/// Blender's square and rectangle are `rectangle`, its disk and ellipse `ellipse`.
enum class AreaShape { rectangle, ellipse };

/// "RECTANGLE" or "ELLIPSE".
std::string_view to_text(AreaShape shape);
/// The shape of that name; "SQUARE" and "DISK" are read as the general forms. Throws std::invalid_argument
/// on any other.
AreaShape area_shape(std::string_view name);

struct PointLight {
    double radius = 0.0;       ///< of the glowing ball, scene unit, 0 or more
    bool soft_falloff = true;  ///< true: a disk that always faces the lit point (Blender's default, and all
                               ///< there was before 4.1); false: a ball

    bool operator==(const PointLight&) const = default;
};

struct SunLight {
    double sun_angle = 0.0;  ///< full angular diameter, radians, 0 to pi

    bool operator==(const SunLight&) const = default;
};

struct SpotLight {
    double radius = 0.0;                       ///< as of a point light
    bool soft_falloff = true;                  ///< as of a point light
    double spot_angle = std::numbers::pi / 4;  ///< full angle of the cone, radians, 0 (no light) to pi
    double spot_blend = 0.15;                  ///< fraction of the cone that fades, 0 (hard edge) to 1
    bool spot_cosine =
        false;  ///< also times the cosine to its axis, as Blender 3.4 has it, 4.5 and later not

    bool operator==(const SpotLight&) const = default;
};

struct AreaLight {
    AreaShape area_shape = AreaShape::rectangle;
    double size_x = 1e-3;  ///< full width along `tangent`, scene unit, 0 (no light, as in Cycles) or more
    double size_y = 1e-3;  ///< full width across it; as small as the defaults: nearly a point
    glm::dvec3 tangent{1.0, 0.0, 0.0};  ///< world direction of size_x, made perpendicular to the light's
                                        ///< direction; parallel to it, or 0: any perpendicular
    double spread = std::numbers::pi;   ///< full angle it shines into, radians, 0 (no light) to pi (Lambert)

    bool operator==(const AreaLight&) const = default;
};

/// What one kind of light has and others have not.
using LightShape = std::variant<PointLight, SunLight, SpotLight, AreaLight>;

/// What a light is made from.
///
/// A reader of a host's lights folds into `color` what tints (node color, black body), and into `power` what
/// scales: node strength, exposure, lights that are not normalized, a host version's own factor. The
/// functions below have these numbers. What cannot be folded is a field: `soft_falloff`, `spot_cosine`.
struct LightSettings {
    LightShape shape = {};
    glm::dvec3 color{1.0};     ///< linear Rec.709, each 0 or more
    glm::dvec3 position{0.0};  ///< world; a sun's does not matter
    glm::dvec3 direction{0.0, 0.0,
                         -1.0};  ///< where it shines to, any length but 0; a point's does not matter
    double power = 1.0;  ///< W, of a sun W/m^2, as in Blender. Negative: takes light away. Mode `paper` asks
                         ///< only whether it is 0
    std::string name = {};  ///< for reports
    bool visible = true;    ///< false: off, left out of every sum

    bool operator==(const LightSettings&) const = default;
};

/// A light that is checked, once, when it is made, and does not change.
class Light {
  public:
    /// A white point light of 1 W at the origin.
    Light() = default;
    /// Throws std::invalid_argument, naming light, field, value and what is allowed, on a value that is not
    /// finite or out of the range given above. Single-precision pi, which hosts have, counts as pi.
    Light(LightSettings settings);  // NOLINT(google-explicit-constructor): as good as its settings

    LightKind kind() const { return static_cast<LightKind>(settings_.shape.index()); }
    const LightSettings& settings() const { return settings_; }
    const LightShape& shape() const { return settings_.shape; }
    const glm::dvec3& color() const { return settings_.color; }
    const glm::dvec3& position() const { return settings_.position; }
    const glm::dvec3& direction() const { return settings_.direction; }
    double power() const { return settings_.power; }
    const std::string& name() const { return settings_.name; }
    bool visible() const { return settings_.visible; }

    /// The same light elsewhere: position, direction and tangent carried along. To see a light from the frame of a
    /// body, move it by the inverse of the body's motion.
    /// @param motion  rotation, with or without a reflection, orthogonal to 1e-5, and translation: on column vectors,
    ///                else std::invalid_argument
    Light moved(const glm::dmat4& motion) const;

    /// All that makes it is the same, its name included.
    bool operator==(const Light&) const = default;

  private:
    LightSettings settings_;
};

/// False for a light that gives nothing: hidden, power 0 or black. It is left out, as if it were not there.
bool is_on(const Light& light);

/// Blender before 4.0 makes a far area light P / (4 d^2) bright, later versions and this library
/// P / (pi d^2): multiply the power of such a light by this. Measured on 3.4.1.
constexpr double legacy_area_power_factor = std::numbers::pi / 4;

/// Factor on the power of a sun in Blender 3.4, whose samples are even on a plane and not on the sky:
/// 2 c / (1 + c), c = cos(angle / 2), on a surface that faces it. Measured on 3.4.1; 4.5 gives the strength.
/// @param angle  radians, 0 to below pi, else std::invalid_argument
double legacy_sun_power_factor(double angle);

/// Factor on the power for a light's exposure (Blender 4.5 and later): 2^stops.
/// @param stops  finite, and small enough that the factor is a double, else std::invalid_argument
double exposure_factor(double stops);

/// Factor on the power of a light whose `normalize` is off (Blender 4.5 and later): an area light's area,
/// a point or spot's 4 pi r^2, a sun's pi sin^2(angle/2). Power then means strength per area of the light.
double unnormalized_power_factor(const Light& light);

/// Color of a black body, linear Rec.709, of Rec.709 luminance 1, no channel below 0 (very red or blue light
/// is outside Rec.709 and is cut): multiplies a light's color, which keeps its luminance, as Blender's
/// `temperature` does.
/// @param kelvin  800 to 20000, Blender's range, else std::invalid_argument
glm::dvec3 black_body_color(double kelvin);

}  // namespace skinglow
