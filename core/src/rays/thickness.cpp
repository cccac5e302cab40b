#include "rays/thickness.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "geometry/vector.h"
#include "geometry/welded_mesh.h"
#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "rays/cone_sampling.h"
#include "rays/ray_scene.h"

namespace skinglow {
namespace {

constexpr int most_rays = 65536;
constexpr std::size_t rays_a_block = 8192;  // some milliseconds: Cancel waits for a block
constexpr double widest_cone = 1.5;  // radians; towards pi/2 rays run along the surface they start from
constexpr double thinnest = 1e-12;   // edges of the unit box: far below what single precision can place
constexpr int openness_rays = 64;    // steps of 1/64 in a share that is compared with a few per cent

void validate(const ThicknessOptions& options) {
    require_positive("unit_mm", options.unit_mm);
    if (options.rays < 1 || options.rays > most_rays) {
        refuse_argument("rays", std::to_string(options.rays), "1 to " + std::to_string(most_rays));
    }
    if (!(options.cone_half_angle >= 0 && options.cone_half_angle <= widest_cone)) {
        refuse_argument("cone_half_angle", to_text(options.cone_half_angle),
                        "0 to " + to_text(widest_cone) + " radians");
    }
    if (!(options.min_openness >= 0 && options.min_openness <= 1)) {
        refuse_argument("min_openness", to_text(options.min_openness), "0 to 1");
    }
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
}

/// Passes shares of the work on to the caller's function, a stretch of [0, 1] for each stage.
class ProgressStage {
  public:
    ProgressStage(const ThicknessProgress& progress, double begin, double end, std::size_t count)
        : progress_(progress), begin_(begin), end_(end), count_(count) {}

    void operator()(std::size_t done) const {
        const double share = static_cast<double>(done) / static_cast<double>(count_);
        if (progress_ && !progress_(begin_ + (end_ - begin_) * share)) throw ThicknessCancelled();
    }

  private:
    const ThicknessProgress& progress_;
    double begin_, end_;
    std::size_t count_;
};

/// Not 0 for each triangle that gets less light than `min_openness`.
std::vector<std::uint8_t> dark_triangles(const WeldedMesh& mesh, const RayScene& scene,
                                         const ThicknessOptions& options, const ProgressStage& done) {
    std::vector<std::uint8_t> dark(mesh.triangles().size());
    const auto directions = cosine_directions(openness_rays);
    for_each_block(
        dark.size(), options.threads,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                dark[i] =
                    scene.openness(static_cast<std::uint32_t>(i), directions) < options.min_openness ? 1 : 0;
            }
        },
        done);
    return dark;
}

/// Thickness at a welded vertex, in edges of the unit box.
/// @param samples  room for the rays' answers, kept between calls
double measure(const WeldedMesh& mesh, const RayScene& scene, std::uint32_t welded,
               std::span<const glm::dvec3> directions, std::vector<WeightedValue>& samples) {
    const double thickest = mesh.diagonal() / mesh.scale();
    const glm::dvec3 inward = -mesh.vertex_normal(welded);
    if (inward == glm::dvec3(0)) return thickest;
    const glm::dmat3 frame = frame_around(inward);
    samples.clear();
    for (const glm::dvec3& local : directions) {
        const glm::dvec3 direction = frame * local;
        const auto exit = scene.exit_triangle(welded, direction);
        if (!exit) continue;
        const WeldedTriangle& triangle = mesh.triangles()[*exit];
        const double height = triangle.plane - glm::dot(triangle.unit_normal, mesh.positions()[welded]);
        const double facing = 1.0 + glm::dot(inward, triangle.unit_normal);
        // 0 where rounding puts the vertex behind the plane; the bound where the plane looks straight back at
        // it.
        const double diameter = height <= 0 ? 0.0 : std::min(2.0 * height / std::max(facing, 1e-9), thickest);
        samples.push_back({1.0 / std::max(diameter, thinnest), glm::dot(direction, triangle.unit_normal)});
    }
    // Of inverses, so that where the cone sees a thin and a thick side at once (the rim of an ear) the thin
    // one, through which light would come, decides.
    return samples.empty() ? thickest : 1.0 / interquartile_mean(samples);
}

std::vector<double> measure_all(const WeldedMesh& mesh, const RayScene& scene,
                                const ThicknessOptions& options, const ProgressStage& done) {
    std::vector<double> values(mesh.positions().size());
    const auto directions = cone_directions(options.rays, options.cone_half_angle);
    const std::size_t vertices_a_block = std::max<std::size_t>(1, rays_a_block / directions.size());
    for_each_block(
        values.size(), options.threads,
        [&](std::size_t begin, std::size_t end) {
            std::vector<WeightedValue> samples;
            samples.reserve(directions.size());
            for (std::size_t i = begin; i < end; ++i) {
                values[i] = measure(mesh, scene, static_cast<std::uint32_t>(i), directions, samples);
            }
        },
        done, vertices_a_block);
    return values;
}

}  // namespace

std::vector<double> thickness(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles,
                              const ThicknessOptions& options, const ThicknessProgress& progress) {
    validate(options);
    if (triangles.empty() && !vertices.empty()) {
        refuse_argument("triangles", "empty", "at least one triangle, or no vertices either");
    }
    const WeldedMesh mesh(vertices, triangles);
    if (!std::isfinite(mesh.diagonal() * options.unit_mm)) {
        refuse_argument("unit_mm", to_text(options.unit_mm), "a mesh below the largest double in mm");
    }
    std::vector<double> result(vertices.size(), 0.0);
    if (mesh.scale() > 0) {  // else every point is the same point, and its box has no diagonal
        RayScene scene(mesh);
        const double cavities_end = options.min_openness > 0 ? 0.5 : 0.0;
        if (options.min_openness > 0) {
            scene.close(
                dark_triangles(mesh, scene, options, {progress, 0.0, cavities_end, mesh.triangles().size()}));
        }
        const auto welded =
            measure_all(mesh, scene, options, {progress, cavities_end, 1.0, mesh.positions().size()});
        // No welded value is above the box's diagonal; the minimum takes back what rounding may have added.
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = std::min(welded[mesh.weld_of()[i]] * mesh.scale(), mesh.diagonal()) * options.unit_mm;
        }
    }
    if (progress && !progress(1.0)) throw ThicknessCancelled();
    return result;
}

}  // namespace skinglow
