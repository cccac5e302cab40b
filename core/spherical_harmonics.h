#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

namespace skinglow {

/// Real orthonormal spherical harmonics up to l = 2 at a unit direction, in the order of Environment.
inline std::array<double, 9> spherical_harmonics(const glm::dvec3& d) {
    constexpr double inverse_pi = std::numbers::inv_pi;
    static const double band0 = 0.5 * std::sqrt(inverse_pi);
    static const double band1 = std::sqrt(0.75 * inverse_pi);
    static const double band2 = 0.5 * std::sqrt(15 * inverse_pi);
    static const double band2_zonal = 0.25 * std::sqrt(5 * inverse_pi);
    return {band0,
            band1 * d.y,
            band1 * d.z,
            band1 * d.x,
            band2 * d.x * d.y,
            band2 * d.y * d.z,
            band2_zonal * (3 * d.z * d.z - 1),
            band2 * d.x * d.z,
            0.5 * band2 * (d.x * d.x - d.y * d.y)};
}

}  // namespace skinglow
