#pragma once

#include <skinglow/environment.h>
#include <skinglow/mesh.h>
#include <skinglow/occlusion.h>
#include <skinglow/rig.h>
#include <skinglow/tissue.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

/// Light through the real shape of a body: solved in the flesh itself, where a table over thickness takes
/// each point for a plate. Method, assumptions and measured errors: docs/shape.md. Lengths mm, coefficients
/// 1/mm, linear Rec.709.
/// @code const skinglow::Shape ear(mesh, skinglow::tissue_preset("light").tissue); const
///        std::vector<glm::dvec3> exitance = ear.exitance(irradiance_of_each_vertex);
/// @endcode
namespace skinglow {

namespace detail {
struct ShapeData;
struct LitShapeData;
}  // namespace detail

/// What the surface of a body does to light that crosses it. Light enters diffused either way.
enum class SurfaceFinish {
    rough,  ///< forgets directions: what comes in and what is thrown back follows the cosine
    smooth  ///< Fresnel's reflectance at each angle, as in slab.h
};

/// "rough" or "smooth".
std::string_view to_text(SurfaceFinish finish);
/// The finish of that name; throws std::invalid_argument on any other.
SurfaceFinish surface_finish(std::string_view name);

/// A homogeneous medium, for three channels that do not mix. Scattering is isotropic.
struct ShapeMedium {
    glm::dvec3 absorption{0.0};  ///< 1/mm, 0 to max_shape_coefficient
    glm::dvec3 reduced_scattering{
        0.0};                       ///< 1/mm, 0 to max_shape_coefficient; a channel must absorb or scatter
    double refractive_index = 1.4;  ///< 1 to 3; outside is air
};
constexpr double max_shape_coefficient = 1e5;
constexpr double max_shape_refractive_index = 3;

struct ShapeOptions {
    double unit_mm = 1.0;  ///< length of one unit of the vertices, mm; finite, above 0
    double cell_mm =
        0.8;  ///< edge of the cells that light is solved on, mm, 0.02 to 1000; 0.5 is final quality
    /// Where the flesh is thicker, mm, or light falls by exp(-5) through it, none is taken to come through: it
    /// has the exitance of a half-space.
    double max_thickness_mm = 25.0;
    SurfaceFinish surface = SurfaceFinish::rough;
    int threads = 0;  ///< 0: one for each processor. The result does not depend on it.
    /// Above 0: cell_mm is not read, but chosen from 0.3 to 1.6 mm so that the estimated error of thin flesh that
    /// is lit from behind, RMS over mean of all channels, is at most this; e.g. 0.15.
    double tolerance = 0;
};

/// Points on a surface; each counts for the nearest point of the triangles that face along its normal.
struct ShapePoints {
    /// Units of the mesh, finite; none: the vertices of the mesh. An empty list is no points at all.
    std::optional<std::span<const glm::dvec3>> points;
    /// One each, finite, of any length, 0: any; empty: all 0. Up to 60 degrees from the triangle's it is the
    /// surface's.
    std::span<const glm::dvec3> normals = {};
};

/// Told the fraction that is done, in [0, 1], ascending, 1 last; returns whether to go on. Called on the thread
/// that asked, every few hundredths of a second, while others work. What it throws ends the work as well; what
/// was asked can be asked again then, and goes on with the parts that are ready.
using ShapeProgress = std::function<bool(double)>;

/// The progress function returned false.
class ShapeCancelled : public std::runtime_error {
  public:
    ShapeCancelled()
        : std::runtime_error("shape: cancelled by the progress function, which returns True to go on") {}
};

/// A thin part of a body, which is solved by itself.
struct ShapePart {
    glm::dvec3 center;                  ///< mean of its points, units of the mesh
    std::vector<std::uint32_t> points;  ///< indices of the points in it, ascending
    bool is_ready = false;              ///< made ready, by the first light that fell on it
    double cell_mm = 0;                 ///< what follows is 0 before
    std::size_t cells = 0;
    std::size_t bytes = 0;
    double lost_area_fraction = 0;  ///< of its surface, where the flesh is too thin for a cell
};

class LitShape;

struct ShapeLightOptions {
    const Environment* environment = nullptr;  ///< none: black
    const Occluders* occluders = nullptr;      ///< other objects, in a frame of their own; none: nothing
    std::vector<std::size_t> excluded = {};    ///< meshes of the occluders that do not count: the body's own
    /// Indices of lights that nothing casts a shadow of, not even the body itself, as hosts have them.
    std::vector<std::size_t> shadowless = {};
    int reentries = 2;        ///< how often light that leaves skin enters skin again, 0 to 8
    int shadow_samples = 16;  ///< rays to a light that has an extent, 1 to 4096
    /// Where the solver stops, of what it began with, 1e-6 to 0.5. 1e-4 leaves 1 % where a thousandth of the light
    /// comes through; 1e-2 is for light that is being moved.
    double solver_tolerance = 1e-4;
    /// The same shape under earlier lights; none: all is solved. Lights that shine as they did, but for color and
    /// power, are taken from there, as they are found amid the same occluders and are solved at least as well: what
    /// changed costs, and the rest nothing. Without use where it is of another shape.
    const LitShape* previous = nullptr;
    /// From the frame of the vertices to that of the occluders, in one unit: as Light::moved. A body that is carried about
    /// keeps its shape and they keep theirs.
    glm::dmat4 occluder_frame{1.0};
};

/// A body under lights. Copies share what was solved; may be asked from many threads at once.
class LitShape {
  public:
    /// What leaves the flesh at each point, W/m^2, 0 or more. Light that the surface throws back, without
    /// having entered, is not in it.
    const std::vector<glm::dvec3>& exitance() const;

    /// What comes through: the exitance less what a half-space of the same flesh would send out under the
    /// irradiance of the point, at least 0. To add to skin that is shaded as lit from its own side.
    const std::vector<glm::dvec3>& transmitted() const;

    /// How far off the exitance is taken to be, W/m^2, as one standard deviation at each point: from how far light
    /// has fallen, the medium and the cells. Above the errors measured in docs/shape.md, up to three times. The
    /// surface and the medium themselves are taken as they are given.
    std::vector<glm::dvec3> error() const;

    /// RMS of error over exitance, by channel: over skin that is lit through, most of whose light is transmitted, or
    /// all of it where there is none, weighted by the light that leaves it. 0 where nothing is solved.
    struct MeanError {
        glm::dvec3 of_all;                 ///< all parts together
        std::vector<glm::dvec3> of_parts;  ///< as Shape::parts
    };
    MeanError mean_error() const;

    /// Irradiance at the vertices of the mesh, of lights and world, shadows included; 0 where it does not
    /// matter.
    const std::vector<glm::dvec3>& irradiance() const;

    std::size_t lights() const;
    /// Lights that give nothing to the body, or less than a thousandth of all together: left out of
    /// exitance().
    const std::vector<std::size_t>& left_out() const;

    /// Exitance by light alone: light k's at point i is [k * points + i]; 0 or more, of a light of negative power 0 or
    /// less: what it takes from the others. The first call solves once for each light, and again for the environment.
    std::vector<glm::dvec3> per_light(const ShapeProgress& progress = {}) const;

    /// The exitance with other colors of the lights: no more than sums once per_light() or this was called.
    /// @param colors  one per light, linear Rec.709, finite, 0 or more; instead of the lights' own
    std::vector<glm::dvec3> recolor(std::span<const glm::dvec3> colors,
                                    const ShapeProgress& progress = {}) const;
    /// The same of transmitted().
    std::vector<glm::dvec3> recolor_transmitted(std::span<const glm::dvec3> colors,
                                                const ShapeProgress& progress = {}) const;

    /// The same light in another skin, in milliseconds and without solving: its spectrum is put together from
    /// what was solved for the tissue of the shape, see Shape::with_tissue.
    LitShape with_tissue(const Tissue& tissue) const;

  private:
    friend class Shape;
    std::shared_ptr<const detail::LitShapeData> data_;
};

/// A body that light is solved in. Copies share what is prepared; may be asked from many threads at once.
class Shape {
  public:
    /// Finds the thin parts. Each is made ready (tenths of a second to seconds) when light first falls on it.
    ///
    /// Flesh is where the triangles wind about a point more than half a time, so that open, doubled,
    /// overlapping and partly flipped meshes have an inside; triangles inside flesh do nothing. A mesh that
    /// encloses nothing is a half-space everywhere.
    /// @param mesh      in units of options.unit_mm; at least one triangle
    /// @param progress  may be empty
    /// @throws std::invalid_argument naming what is not allowed, std::runtime_error where Embree cannot work,
    ///        ShapeCancelled, and what `progress` throws
    Shape(const MeshView& mesh, const ShapeMedium& medium, const ShapeOptions& options = {},
          const ShapePoints& points = {}, const ShapeProgress& progress = {});
    /// The same for skin, whose spectrum is solved at a few nodes.
    Shape(const MeshView& mesh, const Tissue& tissue, const ShapeOptions& options = {},
          const ShapePoints& points = {}, const ShapeProgress& progress = {});

    /// Where exitance is given, units of the mesh: the vertices, or the points on the surface.
    const std::vector<glm::dvec3>& points() const;
    const ShapeOptions& options() const;
    std::size_t vertices() const;

    /// The thin parts, of those that are ready with what they hold.
    std::vector<ShapePart> parts() const;
    /// Memory of what is prepared.
    std::size_t bytes() const;
    /// Fraction of the points, of up to 1000 of them, that have flesh behind them: 0 of an open sheet, which encloses
    /// none. Light comes through flesh alone.
    double enclosed_fraction() const;

    /// What leaves the flesh at each point, W/m^2, without light that enters skin again: at a vertex the mean
    /// about it, weighted by the hat function of its triangles.
    /// @param irradiance  at each vertex of the mesh, W/m^2, up to 1e30; taken as linear on triangles, diffuse
    /// @return one per point, 0 or more. Throws std::invalid_argument naming the entry, ShapeCancelled
    std::vector<glm::dvec3> exitance(std::span<const glm::dvec3> irradiance,
                                     const ShapeProgress& progress = {}) const;

    /// How far off that is taken to be, see LitShape::error; takes as long.
    std::vector<glm::dvec3> exitance_error(std::span<const glm::dvec3> irradiance,
                                           const ShapeProgress& progress = {}) const;

    /// The same under lights, whose shadows the body itself and other objects cast.
    /// @param lights  in the frame and the unit of the vertices; what they bring is irradiance as everywhere
    ///                (rig.h: one unit of length is a meter)
    /// @throws std::invalid_argument naming what is not allowed, ShapeCancelled
    LitShape light(const PreparedRig& lights, const ShapeLightOptions& options = {},
                   const ShapeProgress& progress = {}) const;

    /// The same body of another skin, with what is prepared: light goes on being solved for the flesh of the
    /// tissue that the shape was made of, and the other one's spectrum is put together from that. For sliders;
    /// how far off it is: docs/shape.md. Throws std::invalid_argument, also where the medium is no tissue.
    Shape with_tissue(const Tissue& tissue) const;

    /// For the library's own parts.
    const detail::ShapeData& data() const { return *data_; }

  private:
    std::shared_ptr<const detail::ShapeData> data_;
};

}  // namespace skinglow
