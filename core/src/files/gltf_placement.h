#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "files/gltf_nodes.h"

namespace skinglow::detail {

/// Where the copies of a node's mesh stand: the node itself, or its instances (EXT_mesh_gpu_instancing).
class GltfInstances {
  public:
    /// @param entry   the node in the JSON
    /// @param node    its placement
    /// @param expect  told how many there are before their attributes are read
    GltfInstances(GltfDocument& document, const nlohmann::json& entry, const glm::dmat4& node,
                  const std::function<void(std::size_t)>& expect);

    std::size_t count() const { return count_; }
    glm::dmat4 placement(std::size_t i) const;

  private:
    glm::dmat4 node_;
    std::size_t count_ = 1;
    std::vector<double> translations_, rotations_, scales_;  ///< empty: none
};

/// Puts the vertices of a skinned mesh where its joints take them; its own node's placement does not count
/// (glTF 2.0, chapter Skins).
/// @param vertices  of one primitive
/// @param expect    told how many joints and weights are to be read before they are
/// @return for each vertex 1 where that mirrors
std::vector<std::uint8_t> apply_gltf_skin(GltfDocument& document, const GltfNodes& nodes, std::size_t skin,
                                          const nlohmann::json& attributes, std::span<glm::dvec3> vertices,
                                          const std::string& where,
                                          const std::function<void(std::size_t)>& expect);

bool is_mirrored(const glm::dmat4& matrix);

}  // namespace skinglow::detail
