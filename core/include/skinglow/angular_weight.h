#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// How light enters skin by its angle.
/// @code
/// const std::vector<double> mu = {0.1, 0.5, 1.0};
/// const std::vector<double> transmittance = {0.02, 0.05, 0.06};
/// const skinglow::AngularWeight weight(mu, transmittance);
/// const glm::dvec3 grazing = weight.at(0.2);
/// @endcode
namespace skinglow {

/// w(mu) = max(0, c0 + c1 mu + c2 mu^2 + c3 mu^3) for mu in [0, 1], each channel: for materials, which have no
/// tables.
using AngularCubic = std::array<glm::dvec3, 4>;

/// Every angle enters alike.
constexpr AngularCubic lambert_cubic{glm::dvec3(1.0), glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};

/// The cubic at a cosine, not below 0, as in shaders: the least-squares cubic of a steep weight may be negative,
/// and would subtract light.
/// @param mu  clamped to [0, 1]
glm::dvec3 evaluate(const AngularCubic& cubic, double mu);

/// How much more or less of the light that strikes the far side at an angle comes through than of light from
/// everywhere: w(mu) = T(mu) / T_diffuse, mu the cosine to the normal and T_diffuse = 2 integral of T(mu) mu
/// dmu. Irradiance from direction mu counts w(mu) times. Diffuse light counts once, by definition, so that
/// one table M(d) for diffuse light serves lights from every angle. T is the slab solver's, at a thickness
/// typical of the object.
class AngularWeight {
  public:
    /// Linear between the entries in mu, constant beyond the ends. Any common factor drops out.
    /// @param mu             ascending, in [0, 1], one or more
    /// @param transmittance  as many, finite, 0 or more, not all 0 in a channel
    /// @throws std::invalid_argument naming the entry
    AngularWeight(std::span<const double> mu, std::span<const glm::dvec3> transmittance);
    /// One curve for the three channels.
    /// @param mu             ascending, in [0, 1], one or more
    /// @param transmittance  as many, finite, 0 or more, not all 0
    AngularWeight(std::span<const double> mu, std::span<const double> transmittance);

    /// w at a cosine, clamped to [0, 1].
    glm::dvec3 at(double mu) const;

    /// The largest w of each channel: for bounds.
    glm::dvec3 largest() const { return largest_; }

    /// Integrals of P_l(mu) mu w(mu) dmu over [0, 1] times 2 pi, for l = 0, 1, 2: what a band of spherical
    /// harmonics keeps (pi, 2 pi / 3 and pi / 4 for w = 1; the first is always pi).
    const std::array<glm::dvec3, 3>& band_factors() const { return band_factors_; }

    /// The cubic nearest to w: least squares of mu (cubic - w), which is what irradiance sees, among those
    /// that count diffuse light once, as w does. Of skin it is off by 0.007 of mu w at most
    /// (docs/accuracy.md).
    AngularCubic cubic() const;

  private:
    static constexpr std::size_t intervals = 256;  ///< of the even table that `at` looks up
    std::vector<glm::dvec3> table_;
    glm::dvec3 largest_{0.0};
    std::array<glm::dvec3, 3> band_factors_{};
};

}  // namespace skinglow
