#include "rays/visibility.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/prepared_light.h"
#include "rays/lamp_sampling.h"
#include "rig/surface_irradiance.h"

namespace skinglow {
namespace {

constexpr int most_samples = 4096;
/// What a lamp would bring only weighs places against one another.
constexpr double weight_tolerance = 1e-4;

double fraction(double value) {
    return value - std::floor(value);
}

/// Points of the unit square: the rank-1 lattice of the golden ratio, shifted by the place's own member of
/// the R2 sequence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), whose base
/// is the real root of x^3 = x + 1.
struct ShiftedLattice {
    double shift_u, shift_v;
    int count;

    ShiftedLattice(std::size_t place, int samples) : count(samples) {
        constexpr double plastic = 1.32471795724474602596;
        const auto n = static_cast<double>(place);
        shift_u = fraction(n / plastic);
        shift_v = fraction(n / plastic / plastic);
    }
    double u(int i) const { return fraction((i + 0.5) / count + shift_u); }
    double v(int i) const {
        constexpr double golden = 0.61803398874989484820;
        return fraction(i * golden + shift_v);
    }
};

struct Scene {
    const Occluders& occluders;
    std::vector<TriangleRange> without;
    int samples;
};

bool is_seen(const Scene& scene, const glm::dvec3& point, const LampSample& way) {
    return !scene.occluders.between(point, way.direction, way.distance, scene.without);
}

/// Share of one lamp's light that arrives at a place where it would bring some.
/// @param normal  unit
double share_at(const Scene& scene, const PreparedLight& light, const glm::dvec3& point,
                const glm::dvec3& normal, std::size_t place) {
    if (is_sharp(light, point)) {
        const double away =
            light.kind() == LightKind::sun ? std::numeric_limits<double>::infinity() : light.distance(point);
        return is_seen(scene, point, {light.to_light(point), away, 1.0}) ? 1.0 : 0.0;
    }
    const ShiftedLattice lattice(place, scene.samples);
    double all = 0;
    double seen = 0;
    LampSample highest{};
    double height = -2;
    for (int i = 0; i < scene.samples; ++i) {
        const LampSample way = sample_lamp(light, point, normal, lattice.u(i), lattice.v(i));
        const double cosine = glm::dot(way.direction, normal);
        if (cosine > height) {
            height = cosine;
            highest = way;
        }
        const double weight = std::max(0.0, cosine) * way.emission;
        if (weight == 0.0) continue;
        all += weight;
        if (is_seen(scene, point, way)) seen += weight;
    }
    // A sliver of light between the samples: the way highest above the horizon stands for it.
    if (all == 0.0) return is_seen(scene, point, highest) ? 1.0 : 0.0;
    return std::min(1.0, seen / all);
}

void validate(const VisibilityOptions& options) {
    if (options.samples < 1 || options.samples > most_samples) {
        refuse_argument("samples", std::to_string(options.samples), "1 to " + std::to_string(most_samples));
    }
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
}

/// Mean of a column of shares, each counted by its weight.
double weighted_mean(std::span<const double> shares, std::span<const double> weights, std::size_t column,
                     std::size_t columns) {
    double largest = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) largest = std::max(largest, weights[i]);
    if (largest == 0.0) return 1.0;
    double sum = 0;
    double total = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) {
        sum += weights[i] / largest * shares[i];
        total += weights[i] / largest;
    }
    return std::min(1.0, sum / total);
}

}  // namespace

VisibleShare visible_share(const Occluders& occluders, std::span<const Light> lights,
                           std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                           const VisibilityOptions& options) {
    validate(options);
    require_places(points, normals);
    const Scene scene{occluders, occluders.triangles_of(options.without), options.samples};
    std::vector<PreparedLight> prepared;
    prepared.reserve(lights.size());
    for (const Light& light : lights) {
        validate(light);
        prepared.emplace_back(light);
    }
    const std::size_t columns = lights.size();
    VisibleShare result{std::vector<double>(points.size() * columns, 1.0), std::vector<double>(columns, 1.0)};
    if (occluders.triangles() == 0) return result;
    std::vector<double> brought(result.at_points.size(), 0.0);
    for_each_block(brought.size(), options.threads,
                   [&](std::size_t begin, std::size_t end) {
                       for (std::size_t i = begin; i < end; ++i) {
                           const std::size_t place = i / columns;
                           const std::size_t lamp = i % columns;
                           if (!is_on(lights[lamp]) || normals[place] == glm::dvec3(0.0)) continue;
                           const glm::dvec3 normal = unit(normals[place]);
                           brought[i] = prepared[lamp].irradiance(points[place], normal, weight_tolerance);
                           if (brought[i] > 0.0)
                               result.at_points[i] =
                                   share_at(scene, prepared[lamp], points[place], normal, place);
                       }
                   },
                   {});
    for (std::size_t k = 0; k < columns; ++k)
        result.mean[k] = weighted_mean(result.at_points, brought, k, columns);
    return result;
}

}  // namespace skinglow
