#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace skinglow {

struct ThicknessOptions {
    double unit_mm = 1.0;  ///< length of one unit of the vertices, mm; finite, above 0
    int rays = 128;        ///< per vertex, 1 to 65536; the default's error is in docs/accuracy.md
    double cone_half_angle = std::numbers::pi / 4.0;  ///< between axis and rim of the cone, radians, 0 to 1.5
    /// Smallest share of an even sky's light, 0 to 1, that a far side must get for a ray to end there. What
    /// gets less (the mouth, the eye sockets) is dark: no light comes in, so rays pass it as if it were
    /// flesh. 0: every way out counts, also into a closed cavity. For a head 0.1 serves.
    double min_openness = 0.0;
    int threads = 0;  ///< 0: one for each processor. The result does not depend on it.
};

/// Told the share that is done, in [0, 1], ascending, 1 last; returns whether to go on. Called on the thread
/// that asked for the thickness.
using ThicknessProgress = std::function<bool(double)>;

/// The progress function said no.
class ThicknessCancelled : public std::runtime_error {
  public:
    ThicknessCancelled() : std::runtime_error("thickness: cancelled by the progress function") {}
};

/// How thick a body is at each vertex, mm: the diameter of the ball that lies against the surface there from
/// within and against the far side.
///
/// Rays go in through a cone about the inward normal, as in the shape diameter function (Shapira, Shamir,
/// Cohen-Or, "Consistent mesh partitioning and skeletonisation using the shape diameter function", Visual
/// Computer 24, 2008). Each gives the ball that touches the vertex and the plane of the triangle it leaves
/// through: its diameter is 2 h / (1 + cos b), where h is the vertex's distance from that plane and b the
/// angle between the cone's axis and the plane's normal. For a slab that is its thickness, for a sphere its
/// diameter, whichever way the ray went; for a curved wall it is right to second order in the cone's angle (a
/// shell of a tenth of its radius: within 1 %). Rays count by the cosine at which they leave, so that walls
/// beside them count little. The result is the harmonic mean of the middle half: a quarter of the rays may be
/// misled by a crease, and where some see a thin and some a thick side, the thin one decides, as it does for
/// light.
///
/// What it does with awkward meshes:
/// - Vertices at one position are one vertex and get one value. Triangles without area are left out.
/// - Outward is where the winding (counter-clockwise) says. A mesh of negative volume is turned over, as a
/// whole.
/// - The surfaces of a shell must face away from the wall between them, the inner one into the cavity. A
/// closed
///   surface that faces outwards within another one is a part of the body.
/// - Where no ray finds a way out (a plane, an open hem, a vertex without triangles) the value is the
/// bounding
///   box's diagonal: thicker than anything in the mesh. No value is above that or below 0.
/// - Where the body has a sharp edge the normal is the mean of both sides', and the value up to 27 % too
/// large
///   (the corner of a cube).
/// - Details below about 1e-6 of the mesh's extent are not seen.
///
/// @param vertices   in units of options.unit_mm
/// @param triangles  three vertices each; at least one where there are vertices
/// @return one per vertex, mm; empty for an empty mesh. The same on any number of threads.
/// Throws std::invalid_argument naming the vertex, triangle or option that is not allowed, std::runtime_error
/// where Embree cannot work, ThicknessCancelled, and what `progress` throws.
std::vector<double> thickness(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles,
                              const ThicknessOptions& options = {}, const ThicknessProgress& progress = {});

}  // namespace skinglow
