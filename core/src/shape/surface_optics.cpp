#include "shape/surface_optics.h"

#include <algorithm>
#include <cmath>

#include "numerics/quadrature.h"

namespace skinglow::detail {

double fresnel_reflectance(double n_from, double n_to, double cosine) {
    if (n_from == n_to) return 0.0;
    const double ratio = n_from / n_to;
    const double sine_sq = ratio * ratio * std::max(0.0, 1.0 - cosine * cosine);
    if (sine_sq >= 1.0) return 1.0;
    const double refracted = std::sqrt(1.0 - sine_sq);
    const double across = (n_from * cosine - n_to * refracted) / (n_from * cosine + n_to * refracted);
    const double along = (n_from * refracted - n_to * cosine) / (n_from * refracted + n_to * cosine);
    return 0.5 * (across * across + along * along);
}

DiffuseReflectance diffuse_reflectance(double refractive_index) {
    const double n = refractive_index;
    const double outside =
        integrate<128>([&](double mu) { return 2.0 * mu * fresnel_reflectance(1.0, n, mu); }, 0.0, 1.0);
    return {outside, 1.0 - (1.0 - outside) / (n * n)};
}

}  // namespace skinglow::detail
