#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

/// Light in plane layers of turbid media, by the transport equation. Lengths mm, coefficients 1/mm.
/// @code
/// const std::vector<skinglow::Layer> skin{{1.4, 0.5, 40, 0.75, 0.06}, {1.4, 0.05, 20, 0.75, 3}};
/// const skinglow::SlabResult result = skinglow::slab(skin, skinglow::Incidence::diffuse());
/// // result.reflectance + result.transmittance + the sum of result.absorbed is 1
/// @endcode
namespace skinglow {

/// A plane layer of turbid medium. Scattering follows Henyey and Greenstein (1941, Astrophys J 93:70).
struct Layer {
    double refractive_index = 1.4;  ///< 1 to max_refractive_index
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
    double reflectance = 0;        ///< leaves upwards, the specular reflection at the surface included
    double transmittance = 0;      ///< leaves downwards, the unscattered part included
    double unscattered = 0;        ///< leaves downwards unscattered, after any number of specular reflections
    std::vector<double> absorbed;  ///< per layer
};

/// Transmittance for a collimated beam, by its direction outside.
struct DirectionalTransmittance {
    std::vector<double> mu;      ///< cosine to the normal outside, descending, the first is 1
    std::vector<double> weight;  ///< of a quadrature over the cosine, 0 to 1: their sum is 1
    std::vector<double> transmittance;
};

/// Directions per hemisphere that a solve may use: even numbers from the smallest to the largest.
constexpr int min_streams = 4;
constexpr int max_streams = 128;
/// Far above any material's; beyond, grazing light could not be told from total reflection.
constexpr double max_refractive_index = 100;

/// Solves the transport equation in plane layers by discrete ordinates (Chandrasekhar 1950; layered media
/// with refraction after Jin and Stamnes 1994, Appl Opt 33:431). Every boundary where the index changes
/// reflects by Fresnel's equations for unpolarized light, and refracts by Snell's law; interference is left
/// out. Accuracy by streams: docs/accuracy.md.
///
/// Throws std::invalid_argument that names the layer, the field, its value and what is allowed; also where
/// the streams are too few for the phase function, so that a fraction of the light would come out negative
/// (grazing beams at anisotropies near -1 and 1). Nothing returned is NaN, negative or above 1.
/// @param layers from top to bottom, at least one
/// @param incidence light from above
/// @param n_above refractive index of the medium above, 1 to max_refractive_index
/// @param n_below refractive index of the medium below, 1 to max_refractive_index
/// @param streams directions per hemisphere in the layer of the largest index, even, 4 to 128. Every other
///        index in the stack needs at least two streams of its own, so that many different indices can add
///        to them.
SlabResult slab(std::span<const Layer> layers, Incidence incidence, double n_above = 1, double n_below = 1,
                int streams = 16);

/// Total transmittance for beams from all stream directions above, by one solve: by reciprocity it is the
/// distribution of what diffuse light from below sends out above. Parameters and errors as for slab.
DirectionalTransmittance directional_transmittance(std::span<const Layer> layers, double n_above = 1,
                                                   double n_below = 1, int streams = 16);

namespace detail {
class VariableLayer;
}

/// Transmittance of a stack of layers in which one layer takes any thickness and the others keep theirs. The
/// transport problem of each layer is solved once, on construction; a thickness then costs a small solve of
/// as many unknowns as modes still carry light through the layer. Copies share what was solved; safe to use from
/// many threads at once.
class ThicknessCurve {
  public:
    /// Parameters and errors as for slab.
    /// @param layers of which the variable one's thickness is not read
    /// @param variable_layer index of that layer, below layers.size(). A half-space cannot be it, nor be in
    ///        the stack: nothing would come through.
    ThicknessCurve(std::span<const Layer> layers, std::size_t variable_layer, Incidence incidence,
                   double n_above = 1, double n_below = 1, int streams = 16);

    /// Fraction of the incident flux that comes through, the unscattered part included; 0 where it is below
    /// 1e-300.
    /// @param thickness_mm of the variable layer, finite, 0 or more; else std::invalid_argument
    double transmittance(double thickness_mm) const;

    /// The same for many thicknesses.
    /// @param thickness_mm in any order (ascending is fastest)
    /// @param out of the same size
    void transmittance(std::span<const double> thickness_mm, std::span<double> out) const;

    /// The rate at which log T falls in the end, 1/mm: the diffusion exponent of the variable layer.
    double decay_rate() const;

  private:
    std::shared_ptr<const detail::VariableLayer> layer_;
};

}  // namespace skinglow
