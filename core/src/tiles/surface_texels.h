#pragma once

#include <skinglow/mesh.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "tiles/unit_box.h"

namespace skinglow::detail {

/// What the triangles of a mesh say of the texels of its tiles.
struct SurfaceTexels {
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    std::vector<std::uint32_t>
        triangle;                 ///< of each texel, the first that covers it or the nearest that reads it
    std::vector<float> distance;  ///< of each texel from that triangle; 0: covered
    double area = 0;              ///< of all triangles that have texels, in the unit box
    double texel_area = 0;        ///< of those that lie in one tile, texels
    double mixed_area = 0;        ///< of those that do not lie in one tile
    double held_area = 0;         ///< of those in which a texel lies
    double overlapping_area = 0;  ///< of those in which a texel lies that also lies in one elsewhere
};

/// @param to_unit  applied to the vertices before anything is measured
/// @param texels   three per triangle; checked here. Throws std::invalid_argument
SurfaceTexels surface_texels(const MeshView& mesh, const UnitBox& to_unit, std::span<const glm::vec3> texels,
                             std::size_t height);

}  // namespace skinglow::detail
