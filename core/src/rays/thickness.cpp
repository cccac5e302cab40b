#include <skinglow/thickness.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "rays/direction_sampling.h"
#include "rays/ray_scene.h"

namespace skinglow {
namespace {

constexpr int max_rays = 65536;
constexpr std::size_t rays_per_block = 8192;  // a few milliseconds: Cancel waits for a block
constexpr double max_cone_half_angle =
    1.5;                                // radians; towards pi/2 rays run along the surface they start from
constexpr double min_diameter = 1e-12;  // edges of the unit box: far below what single precision can resolve
constexpr int sky_rays = 64;            // resolution 1/64, for comparison with a few per cent

void validate(const ThicknessOptions& options) {
    require_positive("unit_mm", options.unit_mm);
    require_between("rays", options.rays, 1, max_rays);
    require_between("cone_half_angle", options.cone_half_angle, 0.0, max_cone_half_angle, " radians");
    require_between("min_sky_visibility", options.min_sky_visibility, 0, 1);
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
}

using Done = std::function<void(std::size_t)>;  ///< told the number done, on the caller's thread

/// Reports `count` pieces of work as an interval of [0, 1].
Done stage(const ThicknessProgress& progress, double begin, double end, std::size_t count) {
    return [&progress, begin, end, count](std::size_t done) {
        const double fraction = static_cast<double>(done) / static_cast<double>(count);
        if (progress && !progress(begin + (end - begin) * fraction)) throw ThicknessCancelled();
    };
}

/// Not 0 for each triangle that receives less of the sky than `min_sky_visibility`.
std::vector<std::uint8_t> dark_triangles(const WeldedMesh& mesh, const RayScene& scene,
                                         const ThicknessOptions& options, const Done& done) {
    std::vector<std::uint8_t> dark(mesh.triangles().size());
    const auto directions = cosine_directions(sky_rays);
    for_each_block(
        dark.size(), options.threads,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const double visible = scene.sky_visibility(static_cast<std::uint32_t>(i), directions);
                dark[i] = visible < options.min_sky_visibility ? 1 : 0;
            }
        },
        done);
    return dark;
}

/// What `measure` returns where no ray finds an exit.
constexpr double no_exit = std::numeric_limits<double>::infinity();

/// Thickness at a welded vertex, in edges of the unit box.
/// @param samples  scratch memory, kept between calls
double measure(const WeldedMesh& mesh, const RayScene& scene, std::span<const std::uint8_t> dark,
               std::uint32_t welded, std::span<const glm::dvec3> directions,
               std::vector<WeightedValue>& samples) {
    const double max_diameter = mesh.diagonal() / mesh.scale();
    const glm::dvec3 inward = -mesh.normals()[welded];
    if (inward == glm::dvec3(0)) return no_exit;
    const glm::dmat3 frame = frame_around(inward);
    samples.clear();
    for (const glm::dvec3& local : directions) {
        const glm::dvec3 direction = frame * local;
        const auto exit = scene.exit_triangle(welded, direction, dark);
        if (!exit) continue;
        const WeldedTriangle& triangle = mesh.triangles()[*exit];
        const double distance = triangle.plane - glm::dot(triangle.unit_normal, mesh.positions()[welded]);
        const double facing = 1.0 + glm::dot(inward, triangle.unit_normal);
        // 0 where rounding puts the vertex behind the plane; the bound where the plane faces straight back at
        // it.
        const double diameter =
            distance <= 0 ? 0.0 : std::min(2.0 * distance / std::max(facing, 1e-9), max_diameter);
        samples.push_back(
            {1.0 / std::max(diameter, min_diameter), glm::dot(direction, triangle.unit_normal)});
    }
    // Of inverses, so that where the cone sees a thin and a thick side at once (the rim of an ear) the thin
    // one, through which light would come, decides.
    return samples.empty() ? no_exit : 1.0 / interquartile_mean(samples);
}

std::vector<double> measure_all(const WeldedMesh& mesh, const RayScene& scene,
                                std::span<const std::uint8_t> dark, const ThicknessOptions& options,
                                const Done& done) {
    std::vector<double> values(mesh.positions().size());
    const auto directions = cone_directions(options.rays, options.cone_half_angle);
    const std::size_t vertices_per_block = std::max<std::size_t>(1, rays_per_block / directions.size());
    for_each_block(
        values.size(), options.threads,
        [&](std::size_t begin, std::size_t end) {
            std::vector<WeightedValue> samples;
            samples.reserve(directions.size());
            for (std::size_t i = begin; i < end; ++i) {
                values[i] = measure(mesh, scene, dark, static_cast<std::uint32_t>(i), directions, samples);
            }
        },
        done, vertices_per_block);
    return values;
}

}  // namespace

double ThicknessReport::no_far_side_fraction() const {
    const auto count = std::count(no_far_side.begin(), no_far_side.end(), 1);
    return no_far_side.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(no_far_side.size());
}

std::vector<double> thickness(const MeshView& mesh, const ThicknessOptions& options,
                              const ThicknessProgress& progress) {
    return thickness_report(mesh, options, progress).mm;
}

ThicknessReport thickness_report(const MeshView& mesh, const ThicknessOptions& options,
                                 const ThicknessProgress& progress) {
    validate(options);
    if (mesh.triangles().empty() && !mesh.vertices().empty())
        refuse_argument("triangles", "empty", "at least one triangle, or no vertices either");
    const WeldedMesh body(mesh);
    if (!std::isfinite(body.diagonal() * options.unit_mm))
        refuse_argument("unit_mm", to_text(options.unit_mm), "a mesh below the largest double in mm");
    const std::size_t count = mesh.vertices().size();
    ThicknessReport result{std::vector<double>(count, 0.0), std::vector<std::uint8_t>(count, 1)};
    if (body.scale() > 0) {  // else every vertex is at one point, and the box has no diagonal
        const RayScene scene(body);
        const bool has_dark = options.min_sky_visibility > 0;
        const double dark_end = has_dark ? 0.5 : 0.0;
        const std::vector<std::uint8_t> dark =
            has_dark ? dark_triangles(body, scene, options,
                                      stage(progress, 0.0, dark_end, body.triangles().size()))
                     : std::vector<std::uint8_t>{};
        const auto welded =
            measure_all(body, scene, dark, options, stage(progress, dark_end, 1.0, body.positions().size()));
        // No welded value is above the box's diagonal; the minimum takes back what rounding may have added.
        for (std::size_t i = 0; i < count; ++i) {
            const double value = welded[body.welded_of()[i]];
            result.mm[i] = std::min(value * body.scale(), body.diagonal()) * options.unit_mm;
            result.no_far_side[i] = value == no_exit ? 1 : 0;
        }
    }
    if (progress && !progress(1.0)) throw ThicknessCancelled();
    return result;
}

}  // namespace skinglow
