#include <skinglow/occlusion.h>

#include <algorithm>
#include <string>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/prepared_light.h"
#include "rays/occluder_scene.h"
#include "rays/visible_fraction.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

constexpr int max_samples = 4096;
/// Relative error of the irradiance, which only weighs points against one another.
constexpr double weight_tolerance = 1e-4;

void validate(const VisibilityOptions& options) {
    require_between("samples", options.samples, 1, max_samples);
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
}

/// Weighted mean of a column; 1 where all weights are 0.
double weighted_mean(std::span<const double> values, std::span<const double> weights, std::size_t column,
                     std::size_t columns) {
    double largest = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) largest = std::max(largest, weights[i]);
    if (largest == 0.0) return 1.0;
    double sum = 0;
    double total = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) {
        sum += weights[i] / largest * values[i];
        total += weights[i] / largest;
    }
    return std::min(1.0, sum / total);
}

}  // namespace

VisibleFraction visible_fraction(const Occluders& occluders, const PreparedRig& rig,
                                 std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                                 const VisibilityOptions& options) {
    validate(options);
    require_surface(points, normals);
    const OccluderScene& scene = occluders.scene();
    const std::vector<TriangleRange> excluded = scene.triangles_of(options.excluded);
    const std::vector<RigLight>& lights = rig.data().prepared;
    const std::size_t columns = lights.size();
    VisibleFraction result{std::vector<double>(points.size() * columns, 1.0),
                           std::vector<double>(columns, 1.0)};
    if (scene.triangles() == 0) return result;
    std::vector<double> irradiance(result.at_points.size(), 0.0);
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t p = i / columns;
            const std::size_t k = i % columns;
            if (!lights[k].shines || normals[p] == glm::dvec3(0.0)) continue;
            const glm::dvec3 normal = unit(normals[p]);
            irradiance[i] = lights[k].light.irradiance(points[p], normal, weight_tolerance);
            if (!(irradiance[i] > 0.0)) continue;
            const auto sees = [&](const LightSample& ray) {
                return !scene.occluded(points[p], ray.direction, ray.distance, excluded);
            };
            result.at_points[i] =
                visible_fraction_at(lights[k].light, points[p], normal, p, options.samples, sees);
        }
    };
    for_each_block(irradiance.size(), options.threads, work, {});
    for (std::size_t k = 0; k < columns; ++k)
        result.mean[k] = weighted_mean(result.at_points, irradiance, k, columns);
    return result;
}

}  // namespace skinglow
