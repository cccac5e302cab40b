#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace skinglow::testing {

/// A point and how much brighter the brightest is, as a logarithm.
struct DimmedPoint {
    glm::dvec3 position;  ///< mm
    double dimming;       ///< 0 or more
};

/// What a photon should weigh where it is: as much as light reaches that point, by the crude rule that light
/// is dimmed by a rate times the way from the surface that it enters. So photons are as many everywhere,
/// and those in the dark are light. Only the cost of a Monte Carlo depends on it, not its result.
class WeightWindow {
  public:
    /// A weight of 1 everywhere.
    WeightWindow() = default;

    /// @param lit      where light enters
    /// @param targets  where results are wanted: beyond `radius_mm` of them photons are few
    /// @param rate     1/mm, 0 or more
    WeightWindow(std::span<const DimmedPoint> lit, std::span<const glm::dvec3> targets, double rate,
                 double radius_mm = 9.0);

    /// 1 at the brightest point, above 0 everywhere.
    double weight_at(const glm::dvec3& position) const;

  private:
    static constexpr double cell_mm_ = 1.0;
    std::size_t cell_of(const std::array<int, 3>& at) const;
    std::array<int, 3> at(const glm::dvec3& position) const;
    void spread(std::vector<float>& distance, double rate) const;

    glm::dvec3 low_{0.0};
    std::array<int, 3> size_{};
    std::vector<float> weight_;
};

}  // namespace skinglow::testing
