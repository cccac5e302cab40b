#pragma once

#include <skinglow/spectrum.h>
#include <skinglow/tissue.h>

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

#include "shape/spectral_samples.h"

namespace skinglow::detail {

/// Skin as a few homogeneous media, for solvers of light in a shape, and the way back to color. At the nodes
/// light is solved; between them the logarithm of the exitance is a polynomial in the effective attenuation.
///
/// The epidermis is no part of a node's medium but a factor on what enters and leaves. Each of the 81
/// wavelengths has a factor and a position between the nodes, both chosen so that plane skin 1.5 and 6 mm thick
/// transmits what the layered transport solution (slab.h) says at that wavelength. Its own effective
/// attenuation would be a poorer position: media that share one differ in their albedo, which costs 5 to 20 %.
struct SpectralNodes {
    static constexpr int min_count = 2;
    static constexpr int max_count = max_spectral_nodes;

    /// A medium without epidermis. Irradiance times entry_factor enters it, exit_factor of what leaves it is
    /// seen; between the two the flesh scatters isotropically.
    struct Node {
        double absorption;          ///< 1/mm, above 0
        double reduced_scattering;  ///< 1/mm, above 0
        double entry_factor;        ///< of the node's own wavelength, above 0
        double exit_factor;         ///< the same number: light goes both ways alike
    };
    std::vector<Node> nodes;  ///< ascending by effective attenuation
    double refractive_index;  ///< of every node

    /// The matrix M of a point: M * E is its exitance in linear Rec.709 where light of that color strikes the
    /// shape with irradiance E, as base_lut's matrices are for plane skin.
    /// @param exitance_at_nodes one per node, finite: the exitance where the light has irradiance 1 at every
    ///        wavelength, entry and exit factor of the node included. 0 and less (noise of a solver) is no light.
    ///        A node that is far darker than the others say is raised to that; 0 for all nodes is no light.
    glm::dmat3 combine(std::span<const double> exitance_at_nodes) const;

    /// One per node: together the matrix of what thick skin sends back (thick_skin.h), each wavelength given to
    /// the two nodes next to it. What nodes have of their half-spaces is so many parts of the exact one.
    std::vector<glm::dmat3> thick;
    SpectralSamples samples;  ///< the wavelengths, without those that skin lets nothing through at
};

/// Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param count of nodes, 2 to 8. With 4, plane skin of 1 to 8 mm is at most 7 % off (2 % in the median,
///        in SkinLutReport's norm), 15 % where each epidermis is above 0.12 mm: an epidermis that absorbs is
///        more than a factor to 1 mm of skin, and more nodes do not help there.
SpectralNodes spectral_nodes(const Tissue& tissue, int count = 4);

/// Another tissue by the nodes that are there, so that what was solved at them need not be solved again: its
/// wavelengths get positions between them and factors as above. The farther its flesh is from theirs, the
/// less exact. Throws std::invalid_argument.
SpectralNodes spectral_nodes(const Tissue& tissue, const SpectralNodes& of);

}  // namespace skinglow::detail
