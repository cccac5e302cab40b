#include "environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "argument_check.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;

const double band0 = 0.5 * std::sqrt(1 / pi);
const double band1 = std::sqrt(3 / (4 * pi));
const double band2 = 0.5 * std::sqrt(15 / pi);
const double band2_zonal = 0.25 * std::sqrt(5 / pi);
/// What the harmonics are of their monomials.
const std::array<double, 9> scale = {band0, band1,       band1, band1,      band2,
                                     band2, band2_zonal, band2, 0.5 * band2};

std::array<double, 9> monomials(const glm::dvec3& d) {
    return {1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
}

/// Integrals over one row of pixels, theta from the zenith, of the parts of the harmonics that depend on it;
/// exact, so that a constant image has exactly no higher bands.
struct RowIntegrals {
    double one, z, s, ss, sz, zz;  // of 1, cos, sin, sin^2, sin cos, cos^2, each times sin theta

    RowIntegrals(double from, double to) {
        const auto between = [&](const auto& antiderivative) {
            return antiderivative(to) - antiderivative(from);
        };
        one = between([](double t) { return -std::cos(t); });
        z = between([](double t) { return 0.5 * std::sin(t) * std::sin(t); });
        s = between([](double t) { return 0.5 * t - 0.25 * std::sin(2 * t); });
        ss = between([](double t) { return std::cos(t) * (std::cos(t) * std::cos(t) / 3 - 1); });
        sz = between([](double t) { return std::pow(std::sin(t), 3) / 3; });
        zz = between([](double t) { return -std::pow(std::cos(t), 3) / 3; });
    }
};

/// Sums along one row against the parts of the harmonics that depend on the azimuth.
struct RowSums {
    glm::dvec3 one{0.0}, cosine{0.0}, sine{0.0}, cosine2{0.0}, sine2{0.0};
};

/// The same integrals for each column: of 1, cos, sin, cos 2, sin 2 of the azimuth.
std::vector<std::array<double, 5>> column_integrals(std::size_t width) {
    std::vector<std::array<double, 5>> columns(width);
    for (std::size_t c = 0; c < width; ++c) {
        const double right = pi - 2 * pi * static_cast<double>(c + 1) / static_cast<double>(width);
        const double left = pi - 2 * pi * static_cast<double>(c) / static_cast<double>(width);
        columns[c] = {left - right, std::sin(left) - std::sin(right), std::cos(right) - std::cos(left),
                      0.5 * (std::sin(2 * left) - std::sin(2 * right)),
                      0.5 * (std::cos(2 * right) - std::cos(2 * left))};
    }
    return columns;
}

}  // namespace

Environment::Environment(const glm::dvec3& radiance) {
    coefficients_[0] = require_not_negative("radiance", radiance) * std::sqrt(4 * pi);
}

Environment::Environment(const std::array<glm::dvec3, 9>& coefficients) : coefficients_(coefficients) {
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
        require_finite("coefficients[" + std::to_string(i) + "]", coefficients[i]);
    }
}

Environment Environment::from_equirectangular(std::span<const glm::dvec3> pixels, std::size_t width,
                                              std::size_t height) {
    if (width == 0 || height == 0 || pixels.size() / width != height || pixels.size() % width != 0) {
        refuse_argument("number of pixels", std::to_string(pixels.size()),
                        "width * height of them, at least 1 (" + std::to_string(width) + " by " +
                            std::to_string(height) + ")");
    }
    const std::vector<std::array<double, 5>> columns = column_integrals(width);
    std::array<glm::dvec3, 9> sum{};
    for (std::size_t row = 0; row < height; ++row) {
        RowSums along;
        for (std::size_t c = 0; c < width; ++c) {
            const glm::dvec3& pixel = pixels[row * width + c];
            along.one += pixel * columns[c][0];
            along.cosine += pixel * columns[c][1];
            along.sine += pixel * columns[c][2];
            along.cosine2 += pixel * columns[c][3];
            along.sine2 += pixel * columns[c][4];
        }
        const RowIntegrals theta(pi * static_cast<double>(row) / static_cast<double>(height),
                                 pi * static_cast<double>(row + 1) / static_cast<double>(height));
        sum[0] += along.one * theta.one;
        sum[1] += along.sine * theta.s;
        sum[2] += along.one * theta.z;
        sum[3] += along.cosine * theta.s;
        sum[4] += along.sine2 * (0.5 * theta.ss);
        sum[5] += along.sine * theta.sz;
        sum[6] += along.one * (3 * theta.zz - theta.one);
        sum[7] += along.cosine * theta.sz;
        sum[8] += along.cosine2 * theta.ss;
    }
    for (std::size_t i = 0; i < 9; ++i) {
        sum[i] *= scale[i];
        for (int channel = 0; channel < 3; ++channel) {
            if (!std::isfinite(sum[i][channel]))
                refuse_argument("pixels", "not all finite", "finite radiance");
        }
    }
    return Environment(sum);
}

glm::dvec3 Environment::direction(double u, double v) {
    const double azimuth = pi * (1 - 2 * u);
    const double theta = pi * (1 - v);
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

std::array<double, 9> Environment::harmonics(const glm::dvec3& direction) {
    std::array<double, 9> values = monomials(direction);
    for (std::size_t i = 0; i < 9; ++i) values[i] *= scale[i];
    return values;
}

std::array<glm::dvec3, 9> Environment::irradiance_polynomial(const AngularWeight* angular_weight) const {
    // What the cosine keeps of each band (Ramamoorthi and Hanrahan 2001, Eq. 8).
    const std::array<glm::dvec3, 3> plain = {glm::dvec3(pi), glm::dvec3(2 * pi / 3), glm::dvec3(pi / 4)};
    const std::array<glm::dvec3, 3>& kept =
        angular_weight == nullptr ? plain : angular_weight->band_factors();
    std::array<glm::dvec3, 9> polynomial{};
    for (std::size_t i = 0; i < 9; ++i) {
        const std::size_t band = i == 0 ? 0 : (i < 4 ? 1 : 2);
        polynomial[i] = kept[band] * coefficients_[i] * scale[i];
    }
    return polynomial;
}

glm::dvec3 Environment::irradiance(const glm::dvec3& normal, const AngularWeight* angular_weight) const {
    const std::array<glm::dvec3, 9> polynomial = irradiance_polynomial(angular_weight);
    const std::array<double, 9> at = monomials(normal);
    glm::dvec3 sum = polynomial[0];
    for (std::size_t i = 1; i < 9; ++i) sum += polynomial[i] * at[i];
    // Nine coefficients of a small bright sun swing below 0 on the side away from it.
    return {std::max(sum.r, 0.0), std::max(sum.g, 0.0), std::max(sum.b, 0.0)};
}

glm::dvec3 Environment::mean_irradiance() const {
    const glm::dvec3 mean = coefficients_[0] * (pi * 0.5 * std::sqrt(1 / pi));
    return {std::max(mean.r, 0.0), std::max(mean.g, 0.0), std::max(mean.b, 0.0)};
}

}  // namespace skinglow
