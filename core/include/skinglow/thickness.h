#pragma once

#include <skinglow/mesh.h>

#include <cstdint>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

/// How thick a body is at each vertex of its mesh.
///
/// @code
/// const skinglow::TriangleMesh head(std::move(vertices), std::move(triangles));  // in meters
/// const std::vector<double> mm = skinglow::thickness(head, {.unit_mm = 1000.0, .min_sky_visibility = 0.1});
/// @endcode
namespace skinglow {

struct ThicknessOptions {
    double unit_mm = 1.0;  ///< length of one unit of the vertices, mm; finite, above 0
    int rays = 128;        ///< per vertex, 1 to 65536; the default's error is in docs/accuracy.md
    double cone_half_angle = std::numbers::pi / 4.0;  ///< between axis and rim of the cone, radians, 0 to 1.5
    /// Smallest fraction of a uniform sky's light, 0 to 1, that a far side must receive for a ray to end
    /// there. What receives less (the mouth, the eye sockets) is dark: no light comes in, so rays pass it as
    /// if it were flesh. 0: every exit counts, also into a closed cavity. For a head 0.1 serves.
    double min_sky_visibility = 0.0;
    int threads = 0;  ///< 0: one for each processor. The result does not depend on it.
};

/// Told the fraction that is done, in [0, 1], ascending, 1 last; returns whether to go on. Called on the
/// thread that asked for the thickness.
using ThicknessProgress = std::function<bool(double)>;

/// The progress function returned false.
class ThicknessCancelled : public std::runtime_error {
  public:
    ThicknessCancelled()
        : std::runtime_error("thickness: cancelled by the progress function, which returns True to go on") {}
};

/// Thickness of a body at each vertex, mm: the diameter of the ball that touches the surface there from
/// within, and the far side.
///
/// Rays go in through a cone about the inward normal, as in the shape diameter function (Shapira, Shamir,
/// Cohen-Or, "Consistent mesh partitioning and skeletonisation using the shape diameter function", Visual
/// Computer 24, 2008). Each gives the ball that touches the vertex and the plane of the triangle it leaves
/// through: its diameter is 2 h / (1 + cos b), where h is the vertex's distance from that plane and b the
/// angle between the cone's axis and the plane's normal. For a slab that is its thickness, for a sphere its
/// diameter, whatever the ray's direction; for a curved wall it is right to second order in the cone's angle
/// (a shell of a tenth of its radius: within 1 %). Rays count by the cosine at which they leave, so that
/// walls beside them count little. The result is the harmonic mean of the middle half: a quarter of the rays
/// may be misled by a crease, and where some see a thin and some a thick side, the thin one decides, as it
/// does for light.
///
/// Awkward meshes:
/// - Vertices at one position are one vertex and get one value. Triangles without area are left out.
/// - Outward is where the winding (counter-clockwise) says. A mesh of negative volume is flipped as a whole.
/// - The surfaces of a shell must face away from the wall between them, the inner one into the cavity. A
///   closed surface that faces outwards within another one is a part of the body; so are bodies that touch.
/// - Where no ray finds an exit (a plane, an open hem, a vertex without triangles) the value is the
///   bounding box's diagonal: thicker than anything in the mesh. No value is above that or below 0.
/// - Where the body has a sharp edge the normal is the mean of both sides', and the value up to 27 % too
///   large (the corner of a cube).
/// - A far side within about 1e-6 of the mesh's extent is not seen.
///
/// @param mesh      in units of options.unit_mm; at least one triangle if there are vertices
/// @param options   see there
/// @param progress  may be empty
/// @return one per vertex, mm; empty for an empty mesh. The same on any number of threads.
/// @throws std::invalid_argument naming the option that is not allowed, std::runtime_error where Embree
///         cannot work, ThicknessCancelled, and what `progress` throws
std::vector<double> thickness(const MeshView& mesh, const ThicknessOptions& options = {},
                              const ThicknessProgress& progress = {});

/// Thickness, and where it was found.
struct ThicknessReport {
    std::vector<double> mm;  ///< one per vertex, as thickness() gives it
    std::vector<std::uint8_t>
        no_far_side;  ///< one per vertex: 1 where no ray found an exit, as of open, doubled or
                      ///< flat meshes; the thickness is the box's diagonal there

    /// Fraction of the vertices that found no far side; 0 for an empty mesh.
    double no_far_side_fraction() const;
};

/// As thickness(), and tells where no far side was found. Parameters and errors as there.
ThicknessReport thickness_report(const MeshView& mesh, const ThicknessOptions& options = {},
                                 const ThicknessProgress& progress = {});

}  // namespace skinglow
