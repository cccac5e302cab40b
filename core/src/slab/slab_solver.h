#pragma once

#include <limits>
#include <span>
#include <vector>

namespace skinglow {

/// A plane layer of turbid medium. Scattering follows Henyey and Greenstein (1941, Astrophys J 93:70).
struct Layer {
    double refractive_index = 1.4;  ///< 1 or more
    double absorption = 0;          ///< absorption coefficient, 1/mm, 0 or more
    double scattering = 0;          ///< scattering coefficient, 1/mm, 0 or more
    double anisotropy = 0;          ///< g, the mean cosine of the scattering angle, above -1 and below 1
    /// mm, 0 or more; infinity in the last layer alone: a half-space, which must absorb or scatter.
    double thickness = 0;

    bool operator==(const Layer&) const = default;
};

/// How light falls on the first layer from above.
struct Incidence {
    enum class Kind { normal, diffuse, oblique };
    Kind kind = Kind::normal;
    double mu0 = 1;  ///< cosine to the normal outside, above 0 and at most 1; read by `oblique` alone

    static Incidence normal() { return {Kind::normal, 1}; }
    /// The same radiance from every direction of the upper hemisphere.
    static Incidence diffuse() { return {Kind::diffuse, 1}; }
    static Incidence oblique(double mu0) { return {Kind::oblique, mu0}; }

    bool operator==(const Incidence&) const = default;
};

/// Fractions of the incident flux. reflectance + transmittance + the sum of absorbed = 1.
struct SlabResult {
    double reflectance = 0;    ///< leaves upwards, the mirror reflection at the surface included
    double transmittance = 0;  ///< leaves downwards, the unscattered part included
    double unscattered = 0;  ///< leaves downwards without having been scattered; mirrored any number of times
    std::vector<double> absorbed;  ///< per layer
};

/// Transmittance for a collimated beam, by its direction outside.
struct DirectionalTransmittance {
    std::vector<double> mu;      ///< cosine to the normal outside, descending, the first is 1
    std::vector<double> weight;  ///< of a quadrature over the cosine, 0 to 1: their sum is 1
    std::vector<double> transmittance;
};

/// Directions per hemisphere that a solve may use: even numbers from the least to the most.
constexpr int least_streams = 4;
constexpr int most_streams = 128;

/// Solves the transport equation in plane layers by discrete ordinates (Chandrasekhar 1950; layered media
/// with refraction after Jin and Stamnes 1994, Appl Opt 33:431). Every boundary where the index changes
/// reflects by Fresnel's equations for unpolarized light, and refracts by Snell's law; interference is left
/// out.
///
/// @param layers from top to bottom, at least one. @param n_above, n_below refractive index outside, 1 or
/// more.
/// @param streams directions per hemisphere in the layer of the largest index, even, 4 to 128. Every other
/// index
///        in the stack needs at least two streams of its own, so that many different indices can add to them.
/// Throws std::invalid_argument that names the layer, the field, its value and what is allowed.
/// Accuracy by streams: docs/accuracy.md. Nothing returned is NaN, negative or above 1.
SlabResult solve_slab(std::span<const Layer> layers, Incidence incidence, double n_above = 1,
                      double n_below = 1, int streams = 16);

/// Total transmittance for beams from all stream directions above, by one solve: by reciprocity it is the
/// distribution of what diffuse light from below sends out above. Arguments and errors as for solve_slab.
DirectionalTransmittance directional_transmittance(std::span<const Layer> layers, double n_above = 1,
                                                   double n_below = 1, int streams = 16);

}  // namespace skinglow
