#pragma once

#include <skinglow/shape.h>

#include <glm/mat3x3.hpp>
#include <optional>

#include "shape/shape_solver.h"
#include "shape/spectral_nodes.h"

namespace skinglow::detail {

/// What a shape holds: the solver by nodes, and how nodes make colors.
struct ShapeData {
    ShapeData(const MeshView& mesh, const LaneMedium& medium, std::optional<SpectralNodes> spectrum,
              const ShapeOptions& options, const ShapePoints& points, const ShapeProgress& progress);

    /// Exitance of the sites, and what of it a half-space has, from the irradiance of three channels.
    struct Colors {
        std::vector<glm::dvec3> exitance;
        std::vector<glm::dvec3> reflected;
    };
    /// @param irradiance  one per vertex
    Colors solve(std::span<const glm::dvec3> irradiance, int reentries) const;

    /// The matrix of each site from the irradiance of white light at the vertices, and that of what a
    /// half-space has of it.
    struct Matrices {
        std::vector<glm::mat3> exitance;
        std::vector<glm::mat3> reflected;
    };
    Matrices matrices(std::span<const float> irradiance, int reentries) const;

    /// What the epidermis lets through of light that leaves skin and enters again, by node.
    Lanes on_the_way() const;

    /// The matrix M of a site, exitance M E of light of color E, from its exitance at the nodes.
    glm::dmat3 combine(const Lanes& exitance) const;

    ShapeOptions options;
    std::vector<glm::dvec3> vertices;  ///< as given
    std::vector<glm::dvec3> points;
    std::optional<SpectralNodes> spectrum;  ///< none: three channels
    ShapeSolver solver;

  private:
    void add_channel(Colors& colors, std::span<const Lanes> light, int reentries, int channel) const;
};

}  // namespace skinglow::detail
