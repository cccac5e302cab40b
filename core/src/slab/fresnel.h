#pragma once

namespace skinglow::slab {

/// Fresnel reflectance of unpolarized light between two transparent media. n: refractive indices; cosine: to
/// the normal on the two sides, bound by Snell's law. (Born and Wolf, Principles of Optics, 1.5.2.)
inline double fresnel_reflectance(double n_a, double cosine_a, double n_b, double cosine_b) {
    const double perpendicular = (n_a * cosine_a - n_b * cosine_b) / (n_a * cosine_a + n_b * cosine_b);
    const double parallel = (n_a * cosine_b - n_b * cosine_a) / (n_a * cosine_b + n_b * cosine_a);
    return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

}  // namespace skinglow::slab
