#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// A ray from a point to a point of a light.
struct LightSample {
    glm::dvec3 direction;  ///< unit length
    double distance;       ///< to the light's surface there; infinite for a sun
    double emission;       ///< what comes from there, before the receiver's cosine; 0 or more, any unit
};

/// Whether a light is so small from a point that one ray stands for all.
bool is_sharp(const PreparedLight& light, const glm::dvec3& point);

/// A ray to one of the points that cover a light. Uniform (u, v) in the unit square give samples that, each
/// weighted by emission times the receiver's cosine, stand for the light as PreparedLight has it: disks and
/// balls uniformly in solid angle, flat lights uniformly in area. From within a ball they cover the
/// hemisphere that is faced.
/// @param normal  unit length; only looked at within a ball
LightSample sample_light(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                         double u, double v);

/// Visible fraction of a light at a point where it has an effect, by rays to points that cover it.
/// @param normal   unit length
/// @param index    of the point, for its samples
/// @param samples  rays to a light that has an extent; one goes to a light that has none
/// @param sees     sees(LightSample): whether nothing is in the way of a ray
template <typename Sees>
double visible_fraction_at(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                           std::size_t index, int samples, const Sees& sees) {
    if (is_sharp(light, point)) {
        const bool is_sun = light.kind() == LightKind::sun;
        const double distance = is_sun ? std::numeric_limits<double>::infinity() : light.distance(point);
        return sees(LightSample{light.to_light(point), distance, 1.0}) ? 1.0 : 0.0;
    }
    // Points of the unit square: the rank-1 lattice of the golden ratio, shifted by the point's own member of the R2
    // sequence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), whose base is the real
    // root of x^3 = x + 1.
    constexpr double plastic = 1.32471795724474602596;
    constexpr double golden = 0.61803398874989484820;
    const auto fraction = [](double value) { return value - std::floor(value); };
    const double shift_u = fraction(static_cast<double>(index) / plastic);
    const double shift_v = fraction(static_cast<double>(index) / plastic / plastic);
    double all = 0;
    double seen = 0;
    LightSample highest{};
    double highest_cosine = -2;
    for (int i = 0; i < samples; ++i) {
        const LightSample ray = sample_light(light, point, normal, fraction((i + 0.5) / samples + shift_u),
                                             fraction(i * golden + shift_v));
        const double cosine = glm::dot(ray.direction, normal);
        if (cosine > highest_cosine) {
            highest_cosine = cosine;
            highest = ray;
        }
        const double weight = std::max(0.0, cosine) * ray.emission;
        if (weight == 0.0) continue;
        all += weight;
        if (sees(ray)) seen += weight;
    }
    // A sliver of the light between the samples: the ray highest above the horizon stands for it.
    if (all == 0.0) return sees(highest) ? 1.0 : 0.0;
    return std::min(1.0, seen / all);
}

}  // namespace skinglow::detail
