#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "files/gltf_document.h"

namespace skinglow::detail {

/// The nodes of a glTF file: strict trees, walked without recursion.
struct GltfNodes {
    std::vector<std::size_t> parents;    ///< of each node, or `no_parent`
    std::vector<glm::dmat4> placements;  ///< of each node, in the scene
    std::vector<std::size_t> in_scene;   ///< nodes of the scene that is shown, parents first
    std::size_t meshes_elsewhere = 0;    ///< nodes with a mesh that the scene does not show

    static constexpr std::size_t no_parent = ~std::size_t{0};
};

/// @throws FileError where a node has two parents or is its own ancestor
GltfNodes read_gltf_nodes(const GltfDocument& document);

/// Translation, rotation (x, y, z, w) and scale as one matrix.
glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

}  // namespace skinglow::detail
