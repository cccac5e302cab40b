#pragma once

#include <skinglow/box.h>
#include <skinglow/light.h>

#include <cstddef>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What lights bring to the skin, W/m^2 in linear Rec.709: the E of mode `physical` (docs/method.md), in place
/// of the paper's color times attenuation. Units are those of Blender's renderers, measured: a light of P
/// watts gives
///   point  P / (4 pi (d^2 + r^2)), r its radius as a disk that faces the point; a ball: P / (4 pi d^2)
///   spot   the same times the cone's profile
///   sun    P, whatever the distance
///   area   P / (pi A) radiance, Lambert, from a rectangle or ellipse of area A, times the spread's profile
/// each cut off by the receiver's horizon. One unit of length is a meter. Lights that are off give 0. Negative
/// power subtracts light. A receiver at the light's position is taken to face it; distances are clamped to
/// 1e-6.
/// @code
/// const skinglow::PreparedRig rig(lights);
/// const glm::dvec3 e = skinglow::object_irradiance(rig, point);
/// const skinglow::CullingResult few = rig.cull(skinglow::box_of(vertices), 0.01);
/// @endcode
namespace skinglow {

class AngularWeight;
class Environment;
namespace detail {
struct RigData;
}

/// Why lights are left out for an object.
enum class DropReason {
    off,          ///< hidden, power 0, black, or a cone, spread or area of no width
    unreachable,  ///< the whole box is behind them or outside their cones: they give nothing
    negligible,   ///< together with all other dropped lights within the tolerance
};

/// "off", "unreachable" or "negligible".
std::string_view to_text(DropReason reason);

/// Lights left out together.
struct DroppedLights {
    std::vector<std::size_t> lights;  ///< indices, ascending
    DropReason reason;
    glm::dvec3 bound;  ///< upper bound of what they give at any point of the box, for any normal, W/m^2
};

struct CullingResult {
    std::vector<std::size_t> kept;       ///< indices of the lights that count, ascending
    std::vector<DroppedLights> dropped;  ///< every other light, in one group each
    glm::dvec3 bound{0.0};               ///< sum of the groups' bounds: at most the tolerance
};

/// Lights made ready for everything that is asked of them. Copies share what they hold; all queries may be
/// called from many threads at once. Where a rig is wanted, lights will do; a rig saves preparing them again.
class PreparedRig {
  public:
    PreparedRig() : PreparedRig(std::vector<Light>{}) {}
    PreparedRig(std::vector<Light> lights);     // NOLINT(google-explicit-constructor)
    PreparedRig(std::span<const Light> lights)  // NOLINT(google-explicit-constructor)
        : PreparedRig(std::vector<Light>(lights.begin(), lights.end())) {}
    PreparedRig(std::initializer_list<Light> lights) : PreparedRig(std::vector<Light>(lights)) {}

    const std::vector<Light>& lights() const;
    std::size_t size() const { return lights().size(); }

    /// Leaves out lights whose sum changes no channel of the irradiance by more than the tolerance, at any
    /// point of the box, whatever the normal: proven by bounds, with negative power counted at its size. The
    /// first call makes a tree over the lights, O(n log n); then the work goes with the lights that matter,
    /// not with all.
    /// @param box        of the object, world
    /// @param tolerance  W/m^2, finite, 0 or more; 0 leaves out only what gives nothing
    /// Throws std::invalid_argument on a bad box or tolerance.
    CullingResult cull(const Box& box, double tolerance) const;

    /// For the library's own parts.
    const detail::RigData& data() const { return *data_; }

  private:
    std::shared_ptr<const detail::RigData> data_;
};

/// Default relative tolerance of the integrals for elliptic lights and spreads; the rest is in closed form.
constexpr double default_area_tolerance = 1e-7;

/// Irradiance at one point of a surface.
/// @param point      world, scene unit (meters), finite
/// @param normal     where the surface faces; any length but 0
/// @param tolerance  relative, of the integrals for ellipses and spreads, above 0
/// @return W/m^2, linear Rec.709
/// Throws std::invalid_argument on a bad argument and where the result is beyond the largest double.
glm::dvec3 irradiance_at(const PreparedRig& rig, const glm::dvec3& point, const glm::dvec3& normal,
                         double tolerance = default_area_tolerance);

/// Object weight of each light: irradiance at the point on a surface that faces the center of the light, so
/// without the receiver's cosine (the paper's one lookup table per object has no normal).
/// @return one per light, in the order given. Parameters and errors as above.
std::vector<glm::dvec3> object_irradiance_by_light(const PreparedRig& rig, const glm::dvec3& point,
                                                   double tolerance = default_area_tolerance);

/// E for the whole object: the sum of `object_irradiance_by_light`. (0,0,0) without lights; the order of the
/// lights does not matter beyond the last bits (compensated sum).
glm::dvec3 object_irradiance(const PreparedRig& rig, const glm::dvec3& point,
                             double tolerance = default_area_tolerance);

/// How surface weights are computed.
struct SurfaceOptions {
    double area_tolerance = default_area_tolerance;  ///< relative, of the integrals for ellipses and spreads
    const AngularWeight* angular_weight = nullptr;  ///< none: every angle enters alike (Lambert). Area lights
                                                    ///< count by the angles of their parts
    const Environment* environment = nullptr;       ///< none: black
    int threads = 0;                                ///< 0: one for each processor
};

/// Surface weights: irradiance at many points, each with a normal, its cosine and its horizon. Vectorized
/// over points, on several threads.
/// @param points   world, scene unit (meters), finite
/// @param normals  as many, finite, any length; 0 receives nothing
/// @return one per point, W/m^2, linear Rec.709
/// Throws std::invalid_argument, naming the entry, on bad input and where a result is beyond the largest
/// double.
std::vector<glm::dvec3> surface_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options = {});

/// Points of a surface and where it faces there.
struct SurfacePoints {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;  ///< unit, or 0
};

/// The far side of skin: at x - d n, facing along -n.
/// @param vertices  of the near side, finite
/// @param normals   as many, finite; taken at length 1
/// @param depth     d, one per vertex or one for all, in the scene's unit, finite, 0 or more
/// Throws std::invalid_argument on bad input, naming the entry.
SurfacePoints far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                       std::span<const double> depth);

/// surface_irradiance on the far side of skin. Parameters and errors as both.
std::vector<glm::dvec3> far_side_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth,
                                            const SurfaceOptions& options = {});

/// A cone of directions: all within `half_angle` of `axis`.
struct NormalCone {
    glm::dvec3 axis{0.0, 0.0, 1.0};         ///< unit
    double half_angle = 3.141592653589793;  ///< radians, 0 to pi (every direction)
};

/// The cone about the mean of normals that holds them all; every direction where they cancel out or there are
/// none.
/// @param normals  any length, those of 0 left out; finite, else std::invalid_argument
NormalCone normal_cone(std::span<const glm::dvec3> normals);

/// How far the object weight taken at `point` can be off anywhere in the box, each channel: an upper bound of
/// |object_irradiance(rig, p) - object_irradiance(rig, point)| over the points p of the box; with a cone, of
/// |irradiance_at(rig, p, n) - object_irradiance(rig, point)| also over the normals n of the cone: what one
/// weight for the whole object costs against weights at each point.
/// @param normals  of the far side; none: the receiver's cosine is not counted
/// @return W/m^2, linear Rec.709. Throws std::invalid_argument on bad input.
glm::dvec3 object_irradiance_error(const PreparedRig& rig, const glm::dvec3& point, const Box& box,
                                   const std::optional<NormalCone>& normals = std::nullopt);

/// Lights that shine alike, from one position in one direction, as one light each, their light added: exact to
/// rounding. For scenes that stack lights. What a kind does not have, or not use (a sun's position), does not
/// keep lights apart.
/// @return in order of first appearance; lights that are off are left out. The name is the first one's.
std::vector<Light> merge_identical(std::span<const Light> lights);

/// What a light does for a point, or why it does nothing.
enum class LightState {
    shines,
    hidden,  ///< not visible in the scene
    zero_power,
    black,         ///< color (0, 0, 0)
    no_width,      ///< a cone, spread or area light's size of 0
    occluded,      ///< something stands between
    culled,        ///< left out within the tolerance
    behind_light,  ///< the point is behind an area light
    outside_cone,  ///< of a spot, or of an area light's spread
    behind,        ///< the light is below the receiver's horizon
    too_weak,      ///< less than the smallest double
};

/// "shines", "hidden", "zero power", "black", "no width", "occluded", "culled", "behind light",
/// "outside cone", "behind", "too weak".
std::string_view to_text(LightState state);

struct LightReportEntry {
    std::size_t index;
    std::string name;
    LightKind kind;
    double distance;                     ///< to the center of the light, scene unit; 0 for a sun
    double axis_angle;                   ///< between axis and point, radians; 0 for a point light and a sun
    std::optional<double> normal_angle;  ///< between normal and light, radians; none without a normal
    glm::dvec3 weight;                   ///< what it brings, W/m^2, linear Rec.709
    double share;                        ///< of the luminance of all, by size, 0 to 1; the sum is 1 or 0
    LightState state;
};

/// One entry per light, in the order given. Without a normal the weight is the object weight (a surface that
/// faces each light), with one it is the irradiance with its cosine.
/// @param point     world, scene unit, finite
/// @param normal    none, or of any length but 0
/// @param occluded  empty, or one per light: true, not seen from the point; its weight is 0
/// @param kept      none, or the indices that culling kept: every other light's weight is 0
/// Throws std::invalid_argument on bad input, naming it.
std::vector<LightReportEntry> light_report(
    const PreparedRig& rig, const glm::dvec3& point, const std::optional<glm::dvec3>& normal = std::nullopt,
    const std::vector<bool>& occluded = {},
    const std::optional<std::vector<std::size_t>>& kept = std::nullopt);

}  // namespace skinglow
