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

    /// The matrix M of a site, exitance M E of light of color E, from its exitance at the nodes.
    glm::dmat3 combine(const Lanes& exitance) const;

    ShapeOptions options;
    std::vector<glm::dvec3> vertices;  ///< as given
    std::vector<glm::dvec3> points;
    std::optional<SpectralNodes> spectrum;  ///< none: three channels
    ShapeSolver solver;
};

}  // namespace skinglow::detail
