#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

#include "rays/light_sampling.h"

namespace skinglow::detail {

/// Points of the unit square: the rank-1 lattice of the golden ratio, shifted by the point's own member of
/// the R2 sequence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), whose base
/// is the real root of x^3 = x + 1.
class ShiftedLattice {
  public:
    ShiftedLattice(std::size_t point, int samples) : count_(samples) {
        constexpr double plastic = 1.32471795724474602596;
        const auto n = static_cast<double>(point);
        shift_u_ = fractional_part(n / plastic);
        shift_v_ = fractional_part(n / plastic / plastic);
    }
    double u(int i) const { return fractional_part((i + 0.5) / count_ + shift_u_); }
    double v(int i) const {
        constexpr double golden = 0.61803398874989484820;
        return fractional_part(i * golden + shift_v_);
    }

  private:
    static double fractional_part(double value) { return value - std::floor(value); }

    double shift_u_, shift_v_;
    int count_;
};

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
        if (sees(ray)) seen += weight;
    }
    // A sliver of the light between the samples: the ray highest above the horizon stands for it.
    if (all == 0.0) return sees(highest) ? 1.0 : 0.0;
    return std::min(1.0, seen / all);
}

}  // namespace skinglow::detail
