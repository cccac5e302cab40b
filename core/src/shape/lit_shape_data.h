#pragma once

#include <optional>

#include "shape/shape_data.h"
#include "shape/vertex_light.h"

namespace skinglow::detail {

/// Light of each light by itself, of white color, at the nodes, and of the world.
struct NodeLights {
    std::vector<SiteLight> lights;  ///< without sites: gives nothing
    std::vector<SiteLight> world;   ///< as ShapeData::solve; empty without one
};

/// What was asked for and what was solved, at the nodes: the same for all tissues.
struct SolvedLight {
    std::shared_ptr<const ShapeData> shape;
    PreparedRig rig;
    ShapeLightOptions options;  ///< without environment and occluders
    std::optional<Environment> environment;
    std::optional<Occluders> occluders;
    std::vector<std::size_t> left_out;
    std::vector<glm::dvec3> irradiance;
    std::vector<std::uint8_t> wanted;
    std::vector<SiteLight> together;  ///< as ShapeData::solve; empty: few lights, each by itself
    Lazy<NodeLights> by_light;

    SolvedLight(std::shared_ptr<const ShapeData> of, PreparedRig lights, const ShapeLightOptions& given);
    const NodeLights& each() const;

  private:
    VertexLight vertex_light() const;
    void sum_irradiance(const VertexLight& light);
};

/// Matrices of each light, and the color of the world.
struct LightMatrices {
    std::vector<ShapeData::Matrices> lights;  ///< empty for one that gives nothing
    ShapeData::Colors world;                  ///< empty without one
};

/// What a lit shape holds: what was solved, and the colors that a tissue makes of it.
struct LitShapeData {
    std::shared_ptr<const SolvedLight> solved;
    std::shared_ptr<const ShapeData> shape;
    std::vector<glm::dvec3> exitance;
    std::vector<glm::dvec3> transmitted;
    Lazy<LightMatrices> matrices;

    LitShapeData(std::shared_ptr<const SolvedLight> light, std::shared_ptr<const ShapeData> colors);
    const LightMatrices& by_light() const;

    /// Sum over the lights at the sites, of lights of these colors, and the world.
    ShapeData::Colors sum(std::span<const glm::dvec3> colors) const;
    /// Estimated, one per site.
    std::vector<glm::dvec3> error() const;
};

/// Puts what came through, the exitance less what is reflected, at least 0, into the place of what is reflected.
void keep_transmitted(ShapeData::Colors& found);

}  // namespace skinglow::detail
