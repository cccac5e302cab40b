#pragma once

#include <skinglow/shape.h>

#include <cmath>
#include <glm/mat3x3.hpp>
#include <optional>

#include "numerics/argument_check.h"
#include "numerics/job.h"
#include "shape/shape_solver.h"
#include "shape/spectral_nodes.h"

namespace skinglow::detail {

/// How well light is solved.
struct SolveQuality {
    int reentries = 0;  ///< how often light that leaves skin enters skin again
    /// Of the residual over the light's, in the preconditioner's norm; 1e-4 leaves 1 % where a thousandth comes
    /// through.
    double tolerance = ShapeLightOptions{}.solver_tolerance;

    bool operator==(const SolveQuality&) const = default;
    /// Whether light that is solved this well will do for another.
    bool serves(const SolveQuality& wanted) const {
        return reentries >= wanted.reentries && tolerance <= wanted.tolerance;
    }
};

/// Light that was solved, and the color that it is of.
struct ColoredLight {
    const SiteLight* light;
    glm::dvec3 color;
};

/// Light that was solved, where something else covers the medium.
/// @param ratio  of what that lets through of light that enters skin again, to what it was solved with; by node
SiteLight behind_another(const SiteLight& light, const Lanes& ratio);

/// What a shape holds: the solver by nodes, and how nodes make colors. Light is solved at the nodes and
/// stays there as SiteLight, so that another tissue can make other colors of it.
struct ShapeData {
    ShapeData(const MeshView& mesh, const LaneMedium& medium, std::optional<SpectralNodes> spectrum,
              const ShapeOptions& options, const ShapePoints& points);
    /// The same flesh by another tissue, at the nodes that are there.
    ShapeData(const ShapeData& other, const Tissue& tissue);

    /// The light of three channels at the nodes. One of a medium of three channels, whose lanes they are, and
    /// of gray light; else one per channel.
    /// @param irradiance  one per vertex
    std::vector<SiteLight> solve(std::span<const glm::dvec3> irradiance, const SolveQuality& quality) const;
    /// The same of white light.
    SiteLight solve_white(std::span<const float> irradiance, const SolveQuality& quality) const;

    /// The sum of some lights at the nodes, as solve() gives it: what solving them at once is.
    std::vector<SiteLight> sum(std::span<const ColoredLight> lights) const;

    /// Exitance of the sites, and what of it a half-space has.
    struct Colors {
        std::vector<glm::dvec3> exitance;
        std::vector<glm::dvec3> reflected;
    };
    /// @param solved  of solve() or sum()
    Colors colors(std::span<const SiteLight> solved) const;

    /// For white light the matrix of each site, and that of what a half-space has of it.
    struct Matrices {
        std::vector<glm::mat3> exitance;
        std::vector<glm::mat3> reflected;
    };
    Matrices matrices(const SiteLight& solved) const;

    /// What the epidermis lets through of light that leaves skin and enters again, by node.
    Lanes on_the_way() const;

    /// The matrices M of a site, exitance M E of light of color E, and that of what a half-space has of it.
    ///
    /// Of a tissue, what nodes have beyond their half-spaces' is put together as light that comes through. Up
    /// to that they are parts of what thick skin sends back, which is known: it follows no common law with what
    /// comes through, and wavelengths beyond the last node would be guessed.
    struct Pair {
        glm::dmat3 exitance;
        glm::dmat3 reflected;
    };
    /// @param exitance  at the nodes
    /// @param reflected what a half-space has of it
    Pair combine(const Lanes& exitance, const Lanes& reflected) const;

    /// Whether what a half-space has of light of a color is nowhere negative: a saturated one may be out of gamut.
    bool is_reflected_in_gamut(const glm::dvec3& color) const;

    std::vector<glm::dvec3> at_points(const std::vector<glm::dvec3>& of_sites) const;

    ShapeOptions options;
    std::vector<glm::dvec3> vertices;  ///< as given
    std::vector<glm::dvec3> points;
    std::optional<SpectralNodes> spectrum;  ///< none: three channels
    std::shared_ptr<const ShapeSolver> solver;

  private:
    glm::dmat3 combine(const Lanes& exitance) const;
    void set_thick();
    SiteLight solve_nodes(std::span<Lanes> light, const SolveQuality& quality) const;

    std::vector<glm::dmat3> thick_;  ///< as SpectralNodes::thick, of the surface of the body
    glm::dmat3 all_thick_{0.0};
};

/// Throws std::invalid_argument where a light is too bright for single precision, or not finite.
template <typename Values>
void require_irradiances(const char* name, const Values& irradiance) {
    constexpr double largest = 1e30;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        const glm::dvec3 e(irradiance[i]);
        for (int c = 0; c < 3; ++c) {
            if (!(std::abs(e[c]) <= largest))
                refuse_argument(entry_name(name, i)(), to_text(e[c]),
                                "a finite number of at most 1e30 W/m^2");
        }
    }
}

/// Runs long work that `progress` may stop, told of it on this thread; throws ShapeCancelled.
void run_or_cancel(const ShapeProgress& progress, const std::function<void()>& work);

}  // namespace skinglow::detail
