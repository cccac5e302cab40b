#pragma once

#include <skinglow/angular_weight.h>

#include <array>
#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// What each real orthonormal spherical harmonic up to l = 2 is of its monomial, in the order of Environment:
/// sqrt(1 / (4 pi)), sqrt(3 / (4 pi)), sqrt(15 / (4 pi)), sqrt(5 / (16 pi)), sqrt(15 / (16 pi)).
constexpr std::array<double, 9> harmonic_scales = {
    0.28209479177387814, 0.48860251190291992, 0.48860251190291992, 0.48860251190291992, 1.0925484305920792,
    1.0925484305920792,  0.31539156525252001, 1.0925484305920792,  0.54627421529603959};

/// 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2 of a direction.
constexpr std::array<double, 9> harmonic_monomials(const glm::dvec3& d) {
    return {1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
}

/// A polynomial of those at a unit direction.
inline glm::dvec3 polynomial_at(const std::array<glm::dvec3, 9>& coefficients, const glm::dvec3& d) {
    const std::array<double, 9> monomials = harmonic_monomials(d);
    glm::dvec3 sum = coefficients[0];
    for (std::size_t i = 1; i < 9; ++i) sum += coefficients[i] * monomials[i];
    return sum;
}

/// The harmonics at a unit direction.
constexpr std::array<double, 9> spherical_harmonics(const glm::dvec3& d) {
    std::array<double, 9> values = harmonic_monomials(d);
    for (std::size_t i = 0; i < 9; ++i) values[i] *= harmonic_scales[i];
    return values;
}

/// Irradiance, before it is clamped at 0, of radiance by its harmonics: coefficients of the monomials of the normal.
/// @param angular_weight  none: every angle enters alike
std::array<glm::dvec3, 9> irradiance_polynomial(const std::array<glm::dvec3, 9>& radiance,
                                                const AngularWeight* angular_weight);

}  // namespace skinglow::detail
