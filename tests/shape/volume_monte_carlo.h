#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// Light through a body of turbid medium by brute force: what everything faster is measured by. Photons start
/// on the surface, in proportion to its irradiance, and walk until they leave or are absorbed. Nothing is
/// approximated but the surface itself; the rest is noise.
namespace skinglow::testing {

/// What the body is made of, and its surface. Scattering follows Henyey and Greenstein.
struct TurbidMedium {
    double absorption = 0;        ///< 1/mm
    double scattering = 1;        ///< 1/mm
    double anisotropy = 0;        ///< mean cosine of the scattering angle
    double refractive_index = 1;  ///< 1: the surface does nothing but diffuse what enters
    /// A rough surface reflects the share that a smooth one reflects of diffuse light, and diffuses what it
    /// reflects and what passes; a smooth one follows Fresnel and Snell.
    bool rough = true;
};

struct PhotonBudget {
    std::int64_t photons = 100000;  ///< that start, both halves together
    std::uint64_t seed = 1;         ///< same seed, same result, on any number of threads
    int threads = 0;                ///< 0: one for each processor
    /// Vertices whose result is wanted: only about them photons in the dark are split. Empty: all.
    std::vector<std::uint32_t> targets = {};
};

/// Exitance by vertex, twice, from photons that have nothing in common: the mean of the product of their
/// errors is 0, so that noise can be taken out of any squared difference.
struct Exitance {
    std::array<std::vector<double>, 2> half;  ///< W/m^2, mean over the surface weighted by the vertex' hat
    // Flux, in the unit of irradiance times mm^2:
    double incident = 0;  ///< strikes the surface
    double entered = 0;   ///< is not reflected outside
    double left = 0;      ///< what leaves
    double absorbed = 0;  ///< inside
    double lost = 0;      ///< through holes of the mesh, to where there is no more of it
};

/// Light that has left is gone, even where it would strike the body again. Every incidence is diffuse: a
/// direction distributed as the cosine, then the surface. Surfaces inside the body (an eyeball, a doubled
/// skin) are neither sources nor walls; give them no irradiance.
/// @param points      mm
/// @param triangles   corners counter-clockwise from outside
/// @param irradiance  W/m^2 per vertex, linear on triangles, 0 or more
Exitance volume_monte_carlo(std::span<const glm::dvec3> points, std::span<const glm::uvec3> triangles,
                            std::span<const double> irradiance, const TurbidMedium& medium,
                            const PhotonBudget& budget = {});

}  // namespace skinglow::testing
