#include "radiometry/cap_irradiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinglow::detail {
namespace {

constexpr double pi = std::numbers::pi;

/// A patch so small that it is flat: what of a disk is above a straight horizon, weighted by the height above
/// it.
double flat_cap(double cos_normal, double sin_radius) {
    const double height = cos_normal / sin_radius;  // -1 to 1
    const double half_chord = std::sqrt(std::max(0.0, 1.0 - height * height));
    const double area = std::acos(-height) + height * half_chord;
    const double moment = 2.0 / 3.0 * half_chord * half_chord * half_chord;
    return (cos_normal * area + sin_radius * moment) / pi;
}

}  // namespace

double cap_irradiance(double cos_normal, double sin_radius) {
    if (cos_normal >= sin_radius) return cos_normal;
    if (cos_normal <= -sin_radius) return 0.0;
    // The closed form subtracts terms that are 1/sin_radius^2 larger than their difference; the flat form's
    // own error is of the order of sin_radius^3.
    if (sin_radius < 1e-4) return flat_cap(cos_normal, sin_radius);
    const double cot_radius = std::sqrt(std::max(0.0, 1.0 - sin_radius * sin_radius)) / sin_radius;
    const double sin_normal = std::sqrt(std::max(0.0, 1.0 - cos_normal * cos_normal));
    const double rise = std::clamp(-cot_radius * cos_normal / sin_normal, -1.0, 1.0);
    const double chord = sin_normal * std::sqrt(1.0 - rise * rise);
    const double of_patch = cos_normal * std::acos(rise) - cot_radius * chord;
    const double of_horizon = std::atan2(chord, cot_radius);
    return std::clamp((of_patch + of_horizon / (sin_radius * sin_radius)) / pi, 0.0, 1.0);
}

}  // namespace skinglow::detail
