#include <skinglow/environment.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "radiometry/spherical_harmonics.h"

namespace skinglow {
namespace {

using std::numbers::pi;

}  // namespace

std::array<glm::dvec3, 9> detail::irradiance_polynomial(const std::array<glm::dvec3, 9>& radiance,
                                                        const AngularWeight* angular_weight) {
    // What the cosine keeps of each band (Ramamoorthi and Hanrahan 2001, Eq. 8).
    const std::array<glm::dvec3, 3> plain = {glm::dvec3(pi), glm::dvec3(2 * pi / 3), glm::dvec3(pi / 4)};
    const std::array<glm::dvec3, 3>& kept =
        angular_weight == nullptr ? plain : angular_weight->band_factors();
    std::array<glm::dvec3, 9> polynomial{};
    for (std::size_t i = 0; i < 9; ++i) {
        const std::size_t band = i == 0 ? 0 : (i < 4 ? 1 : 2);
        polynomial[i] = kept[band] * radiance[i] * harmonic_scales[i];
    }
    return polynomial;
}

Environment::Environment(const glm::dvec3& radiance) {
    require_not_negative("radiance", radiance);
    require("radiance", radiance, max_abs(radiance) <= max_radiance, "three numbers of 0 to 1e30 W/(m^2 sr)");
    coefficients_[0] = radiance * std::sqrt(4 * pi);
}

Environment::Environment(const std::array<glm::dvec3, 9>& coefficients) : coefficients_(coefficients) {
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
        require_finite(entry_name("coefficients", i), coefficients[i]);
        require(entry_name("coefficients", i), coefficients[i], max_abs(coefficients[i]) <= max_coefficient,
                "three numbers of at most 4e30: no radiance of up to 1e30 W/(m^2 sr) has larger ones");
    }
}

glm::dvec3 Environment::direction(double u, double v) {
    const double azimuth = pi * (1 - 2 * u);
    const double theta = pi * (1 - v);
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

Environment Environment::rotated(const glm::dmat3& rotation) const {
    // Of a matrix from single-precision angles, with a margin.
    if (!is_orthogonal(rotation, 1e-5)) {
        refuse_argument("rotation", to_text(rotation[0]) + to_text(rotation[1]) + to_text(rotation[2]),
                        "an orthogonal matrix, to 1e-5");
    }
    // Not checked again: coefficients at the end of what is allowed may turn into larger ones.
    Environment result = *this;
    std::array<glm::dvec3, 9>& turned = result.coefficients_;
    for (int channel = 0; channel < 3; ++channel) {
        const auto at = [&](std::size_t i) { return coefficients_[i][channel]; };
        // Band 1 is a vector, band 2 a quadratic form without trace, d^T Q d: both turn as such, exactly.
        const glm::dvec3 vector = rotation * glm::dvec3(at(3), at(1), at(2));
        turned[1][channel] = vector.y;
        turned[2][channel] = vector.z;
        turned[3][channel] = vector.x;
        // In units of the constant before xy; 3z^2 - 1 has 1 / sqrt(12) of it.
        const double across = 0.5 * at(8);
        const double zonal = at(6) / std::sqrt(12.0);
        const glm::dmat3 form = {across - zonal, 0.5 * at(4), 0.5 * at(7), 0.5 * at(4), -across - zonal,
                                 0.5 * at(5),    0.5 * at(7), 0.5 * at(5), 2 * zonal};
        const glm::dmat3 q = rotation * form * glm::transpose(rotation);
        turned[4][channel] = 2 * q[1][0];
        turned[5][channel] = 2 * q[2][1];
        turned[6][channel] = 0.5 * q[2][2] * std::sqrt(12.0);
        turned[7][channel] = 2 * q[2][0];
        turned[8][channel] = q[0][0] - q[1][1];
    }
    return result;
}

std::array<glm::dvec3, 9> Environment::irradiance_polynomial(const AngularWeight* angular_weight) const {
    return detail::irradiance_polynomial(coefficients_, angular_weight);
}

glm::dvec3 Environment::irradiance(const glm::dvec3& normal, const AngularWeight* angular_weight) const {
    // Nine coefficients of a small bright sun go below 0 on the side opposite to it.
    return glm::max(polynomial_at(irradiance_polynomial(angular_weight), normal), 0.0);
}

glm::dvec3 Environment::mean_irradiance_error() const {
    // The largest size of each monomial on the sphere.
    constexpr std::array<double, 9> largest = {0, 1, 1, 1, 0.5, 0.5, 2, 0.5, 1};
    const std::array<glm::dvec3, 9> polynomial = irradiance_polynomial();
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i < 9; ++i) sum += glm::abs(polynomial[i]) * largest[i];
    return sum;
}

glm::dvec3 Environment::mean_irradiance() const {
    return glm::max(coefficients_[0] * (pi * harmonic_scales[0]), 0.0);
}

}  // namespace skinglow
