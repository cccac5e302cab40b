#include <skinglow/angular_weight.h>

#include <Eigen/LU>
#include <algorithm>
#include <glm/common.hpp>
#include <numbers>
#include <string>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

void validate_curve(std::span<const double> mu, std::span<const glm::dvec3> transmittance) {
    if (mu.empty() || mu.size() != transmittance.size()) {
        refuse_argument("number of transmittances", std::to_string(transmittance.size()),
                        "as many as mu has entries (" + std::to_string(mu.size()) + "), at least 1");
    }
    for (std::size_t i = 0; i < mu.size(); ++i) {
        if (!(mu[i] >= 0.0 && mu[i] <= 1.0)) refuse_value(entry_name("mu", i), mu[i], "a cosine of 0 to 1");
        if (i > 0 && mu[i] <= mu[i - 1])
            refuse_value(entry_name("mu", i), mu[i], "above the entry before it");
        require_not_negative(entry_name("transmittance", i), transmittance[i]);
    }
}

glm::dvec3 interpolate(std::span<const double> mu, std::span<const glm::dvec3> values, double x) {
    const auto above = std::upper_bound(mu.begin(), mu.end(), x);
    if (above == mu.begin()) return values.front();
    if (above == mu.end()) return values.back();
    const auto i = static_cast<std::size_t>(above - mu.begin());
    const double t = (x - mu[i - 1]) / (mu[i] - mu[i - 1]);
    return values[i - 1] * (1.0 - t) + values[i] * t;
}

}  // namespace

AngularWeight::AngularWeight(std::span<const double> mu, std::span<const double> transmittance)
    : AngularWeight(mu, std::vector<glm::dvec3>(transmittance.begin(), transmittance.end())) {}

AngularWeight::AngularWeight(std::span<const double> mu, std::span<const glm::dvec3> transmittance) {
    validate_curve(mu, transmittance);
    table_.resize(intervals + 1);
    for (std::size_t i = 0; i <= intervals; ++i) {
        table_[i] = interpolate(mu, transmittance, static_cast<double>(i) / intervals);
    }
    // The table is what is looked up, so it is its integrals that must be exact: Simpson's rule is, for the
    // products of straight pieces with mu and mu^2; for mu^3 it is off by less than 1e-8.
    std::array<glm::dvec3, 3> integral{};
    for (std::size_t i = 0; i < intervals; ++i) {
        const double left = static_cast<double>(i) / intervals;
        const double step = 1.0 / intervals;
        for (const auto& [t, weight] :
             {std::pair(0.0, 1.0 / 6), std::pair(0.5, 4.0 / 6), std::pair(1.0, 1.0 / 6)}) {
            const double x = left + t * step;
            const glm::dvec3 term = (table_[i] * (1.0 - t) + table_[i + 1] * t) * (weight * step * x);
            integral[0] += term;
            integral[1] += term * x;
            integral[2] += term * (1.5 * x * x - 0.5);
        }
    }
    const glm::dvec3 diffuse = 2.0 * integral[0];
    for (int channel = 0; channel < 3; ++channel) {
        if (!(diffuse[channel] > 0.0))
            refuse_argument("transmittance for diffuse light", to_text(diffuse[channel]), "above 0");
    }
    for (std::size_t band = 0; band < 3; ++band)
        band_factors_[band] = 2.0 * std::numbers::pi * integral[band] / diffuse;
    for (glm::dvec3& entry : table_) {
        entry /= diffuse;
        largest_ = glm::max(largest_, entry);
    }
}

glm::dvec3 AngularWeight::at(double mu) const {
    const double index = std::clamp(mu, 0.0, 1.0) * intervals;
    const auto i = std::min(static_cast<std::size_t>(index), intervals - 1);
    const double t = index - static_cast<double>(i);
    return table_[i] * (1.0 - t) + table_[i + 1] * t;
}

glm::dvec3 evaluate(const AngularCubic& cubic, double mu) {
    const double x = std::clamp(mu, 0.0, 1.0);
    return glm::max(cubic[0] + x * (cubic[1] + x * (cubic[2] + x * cubic[3])), 0.0);
}

AngularCubic AngularWeight::cubic() const {
    // Normal equations with the constraint 2 integral of mu cubic dmu = 1 by a Lagrange multiplier. All
    // integrals are sums over the table, of which w is made.
    Eigen::Matrix<double, 5, 5> system = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 3> right = Eigen::Matrix<double, 5, 3>::Zero();
    for (std::size_t i = 0; i <= intervals; ++i) {
        const double mu = static_cast<double>(i) / intervals;
        const Eigen::Vector4d power = mu * Eigen::Vector4d(1.0, mu, mu * mu, mu * mu * mu);
        system.topLeftCorner<4, 4>() += power * power.transpose();
        right.topRows<4>() += mu * power * Eigen::RowVector3d(table_[i].r, table_[i].g, table_[i].b);
    }
    for (int j = 0; j < 4; ++j) system(4, j) = system(j, 4) = 2.0 / (j + 2.0);
    right.row(4).setOnes();
    const Eigen::Matrix<double, 5, 3> solution = system.fullPivLu().solve(right);
    AngularCubic cubic{};
    for (std::size_t j = 0; j < cubic.size(); ++j) {
        const auto row = static_cast<Eigen::Index>(j);
        cubic[j] = {solution(row, 0), solution(row, 1), solution(row, 2)};
    }
    return cubic;
}

}  // namespace skinglow
