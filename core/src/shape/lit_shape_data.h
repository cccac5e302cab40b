#pragma once

#include <optional>
#include <utility>

#include "shape/shape_error.h"
#include "shape/solved_light.h"

namespace skinglow::detail {

/// Colors that a tissue makes of what is solved of a light, and of the world.
struct LightColors {
    explicit LightColors(std::shared_ptr<const WhiteLight> of) : light(std::move(of)) {}

    std::shared_ptr<const WhiteLight> light;
    Lazy<ShapeData::Matrices> matrices;    ///< empty where it gives nothing
    Lazy<std::vector<glm::mat3>> through;  ///< exitance less what is reflected
};
struct WorldColors {
    explicit WorldColors(std::shared_ptr<const WorldLight> of) : world(std::move(of)) {}

    std::shared_ptr<const WorldLight> world;
    Lazy<ShapeData::Colors> colors;
};

/// What a lit shape holds: what was solved, and the colors that a tissue makes of it.
struct LitShapeData {
    std::shared_ptr<const SolvedLight> solved;
    std::shared_ptr<const ShapeData> shape;
    std::vector<glm::dvec3> exitance;
    std::vector<glm::dvec3> transmitted;

    /// @param previous  null: none
    LitShapeData(std::shared_ptr<const SolvedLight> light, std::shared_ptr<const ShapeData> colors,
                 const LitShapeData* previous);

    /// Makes the matrices of each light that may shine, and the colors of the world.
    void solve_each() const;
    bool is_each_solved() const;

    /// Exitance of white light; none: gives nothing, or is not solved.
    const ShapeData::Matrices* matrices(std::size_t light) const;

    /// Sum over the lights at the sites, of lights of these colors, and the world. Of those that are not black,
    /// what is solved.
    ShapeData::Colors sum(std::span<const glm::dvec3> colors) const;
    /// What comes through, at the points, of lights of these colors and the world.
    std::vector<glm::dvec3> transmitted_of(std::span<const glm::dvec3> colors) const;
    /// Estimated, one per site.
    std::vector<glm::dvec3> error() const;
    MeanError mean_error() const;

  private:
    /// Calls `use` with light as the tissue has it that makes the colors.
    template <typename Use>
    auto in_tissue(const SiteLight& light, const Use& use) const;
    std::vector<SiteLight> sum_of_parts() const;
    const std::vector<glm::mat3>& through(std::size_t light, const ShapeData::Matrices& of_light) const;
    /// Null: black, or not solved.
    const ShapeData::Colors* world_colors() const;

    /// What the tissue lets through of light that enters again, over what it was solved with; none: as much.
    std::optional<Lanes> entering_;
    std::vector<std::shared_ptr<const LightColors>> lights_;
    std::shared_ptr<const WorldColors> world_;  ///< null: black
};

/// Puts what came through, the exitance less what is reflected, at least 0, into the place of what is reflected.
void keep_transmitted(ShapeData::Colors& found);

}  // namespace skinglow::detail
