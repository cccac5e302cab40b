#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "radiometry/prepared_light.h"

namespace skinglow::detail {

/// A ray from a point to a point of a light.
struct LightSample {
    glm::dvec3 direction;  ///< unit length
    double distance;       ///< to the light's surface there; infinite for a sun
    double emission;       ///< what comes from there, before the receiver's cosine; 0 or more, any unit
};

/// Rays from a point to the points that cover a light.
class LightSampler {
  public:
    /// @param normal  unit length; only looked at within a ball
    LightSampler(const PreparedLight& light, const glm::dvec3& point, const glm::dvec3& normal);

    /// Sine of the angular radius of a light whose center is this far away, about; above 1 where it is all around.
    static double sine_at(const PreparedLight& light, double distance);
    /// Whether it is so small that one ray, to its center, stands for all.
    bool is_sharp() const { return is_sharp_; }
    LightSample center() const { return {to_center_, distance_, 1.0}; }

    /// Uniform (u, v) in the unit square give samples that, each weighted by emission times the receiver's
    /// cosine, stand for the light as PreparedLight has it: disks and balls uniformly in solid angle, flat lights
    /// uniformly in area. From within a ball they cover the hemisphere that is faced.
    LightSample at(double u, double v) const;

    const glm::dvec3& normal() const { return normal_; }

  private:
    glm::dvec3 on_cap(double u, double v) const;
    LightSample on_ball(double u, double v) const;
    LightSample on_area(double u, double v) const;

    const PreparedLight* light_;
    glm::dvec3 point_;
    glm::dvec3 normal_;
    glm::dvec3 to_center_;
    double distance_;  ///< to the center; infinite for a sun
    bool is_sharp_;
    bool inside_ = false;    ///< of a ball
    glm::dmat3 frame_{1.0};  ///< about the middle of a sun's or ball's directions
    double cap_height_ = 0;  ///< 1 - cos of their angular radius
};

/// Calls `use(LightSample, weight)` for the rays that tell how much of a light is seen at a point where it has an
/// effect: the visible fraction is the weight of those that nothing is in the way of, over that of all, which is above 0.
/// @param sampler  of the light and the point
/// @param index    of the point, for its samples
/// @param samples  rays to a light that has an extent; one goes to a light that has none
template <typename Use>
void for_each_light_sample(const LightSampler& sampler, std::size_t index, int samples, const Use& use) {
    if (sampler.is_sharp()) {
        use(sampler.center(), 1.0);
        return;
    }
    // Points of the unit square: the rank-1 lattice of the golden ratio, shifted by the point's own member of the R2
    // sequence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), whose base is the real
    // root of x^3 = x + 1.
    constexpr double plastic = 1.32471795724474602596;
    constexpr double golden = 0.61803398874989484820;
    const auto fraction = [](double value) { return value - std::floor(value); };
    const double shift_u = fraction(static_cast<double>(index) / plastic);
    const double shift_v = fraction(static_cast<double>(index) / plastic / plastic);
    bool is_any = false;
    LightSample highest{};
    double highest_cosine = -2;
    for (int i = 0; i < samples; ++i) {
        const LightSample ray =
            sampler.at(fraction((i + 0.5) / samples + shift_u), fraction(i * golden + shift_v));
        const double cosine = glm::dot(ray.direction, sampler.normal());
        if (cosine > highest_cosine) {
            highest_cosine = cosine;
            highest = ray;
        }
        const double weight = std::max(0.0, cosine) * ray.emission;
        if (weight == 0.0) continue;
        is_any = true;
        use(ray, weight);
    }
    // A sliver of the light between the samples: the ray highest above the horizon stands for it.
    if (!is_any) use(highest, 1.0);
}

/// Visible fraction of a light at a point where it has an effect, by rays to points that cover it.
/// @param sees     sees(LightSample): whether nothing is in the way of a ray
template <typename Sees>
double visible_fraction_at(const LightSampler& sampler, std::size_t index, int samples, const Sees& sees) {
    double all = 0;
    double seen = 0;
    for_each_light_sample(sampler, index, samples, [&](const LightSample& ray, double weight) {
        all += weight;
        if (sees(ray)) seen += weight;
    });
    return std::min(1.0, seen / all);
}

}  // namespace skinglow::detail
