#include <skinglow/occlusion.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/prepared_light.h"
#include "rays/light_sampling.h"
#include "rays/occluder_scene.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

constexpr int max_samples = 4096;
/// Relative error of the irradiance, which only weighs points against one another.
constexpr double weight_tolerance = 1e-4;

double fractional_part(double value) {
    return value - std::floor(value);
}

/// Points of the unit square: the rank-1 lattice of the golden ratio, shifted by the point's own member of
/// the R2 sequence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), whose base
/// is the real root of x^3 = x + 1.
struct ShiftedLattice {
    double shift_u, shift_v;
    int count;

    ShiftedLattice(std::size_t point, int samples) : count(samples) {
        constexpr double plastic = 1.32471795724474602596;
        const auto n = static_cast<double>(point);
        shift_u = fractional_part(n / plastic);
        shift_v = fractional_part(n / plastic / plastic);
    }
    double u(int i) const { return fractional_part((i + 0.5) / count + shift_u); }
    double v(int i) const {
        constexpr double golden = 0.61803398874989484820;
        return fractional_part(i * golden + shift_v);
    }
};

/// What is asked of one light at each point.
struct Query {
    const OccluderScene& scene;
    std::vector<TriangleRange> excluded;
    int samples;

    bool sees(const glm::dvec3& point, const LightSample& ray) const {
        return !scene.occluded(point, ray.direction, ray.distance, excluded);
    }

    /// Visible fraction of a light at a point where it has an effect.
    /// @param normal  unit length
    /// @param index   of the point, for its samples
    double fraction(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                    std::size_t index) const {
        if (is_sharp(light, point)) {
            const bool is_sun = light.kind() == LightKind::sun;
            const double distance = is_sun ? std::numeric_limits<double>::infinity() : light.distance(point);
            return sees(point, {light.to_light(point), distance, 1.0}) ? 1.0 : 0.0;
        }
        const ShiftedLattice lattice(index, samples);
        double all = 0;
        double seen = 0;
        LightSample highest{};
        double highest_cosine = -2;
        for (int i = 0; i < samples; ++i) {
            const LightSample ray = sample_light(light, point, normal, lattice.u(i), lattice.v(i));
            const double cosine = glm::dot(ray.direction, normal);
            if (cosine > highest_cosine) {
                highest_cosine = cosine;
                highest = ray;
            }
            const double weight = std::max(0.0, cosine) * ray.emission;
            if (weight == 0.0) continue;
            all += weight;
            if (sees(point, ray)) seen += weight;
        }
        // A sliver of the light between the samples: the ray highest above the horizon stands for it.
        if (all == 0.0) return sees(point, highest) ? 1.0 : 0.0;
        return std::min(1.0, seen / all);
    }
};

void validate(const VisibilityOptions& options) {
    if (options.samples < 1 || options.samples > max_samples)
        refuse_argument("samples", std::to_string(options.samples), "1 to " + std::to_string(max_samples));
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
    const Query query{scene, scene.triangles_of(options.excluded), options.samples};
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
            if (irradiance[i] > 0.0)
                result.at_points[i] = query.fraction(lights[k].light, points[p], normal, p);
        }
    };
    for_each_block(irradiance.size(), options.threads, work, {});
    for (std::size_t k = 0; k < columns; ++k)
        result.mean[k] = weighted_mean(result.at_points, irradiance, k, columns);
    return result;
}

}  // namespace skinglow
