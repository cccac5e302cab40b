#pragma once

#include <skinglow/box.h>
#include <skinglow/rig.h>

#include <cstdint>
#include <span>
#include <vector>

#include "rig/rig_data.h"

namespace skinglow::detail {

/// Lights in a binary tree over their positions, so that for each object only those are looked at that may
/// matter. A node knows the box its lights stand in, a bound of what they give together, and a cone that holds
/// all that they shine into (as in A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", HPG 2018, where such nodes serve sampling; here they bound what is left out).
class LightTree {
  public:
    /// @param lights  have to outlive the tree
    explicit LightTree(std::span<const RigLight> lights);

    /// Culls the root, then splits the node with the largest bound until the culled remainder is within
    /// tolerance. See PreparedRig.
    CullingResult cull(const Box& box, double tolerance) const;

  private:
    struct Node {
        std::size_t begin, end;  ///< leaves of it, in leaves_
        std::int64_t left = -1;  ///< -1: one leaf
        std::int64_t right = -1;
        Box extent;                   ///< all that glows
        glm::dvec3 at_distance{0.0};  ///< sum of upper bounds at a distance of 1
        glm::dvec3 anywhere{0.0};     ///< sum of upper bounds at any distance
        NormalCone cone;              ///< that they shine into
    };

    std::int64_t build(std::size_t begin, std::size_t end);
    Node node_of_leaf(std::size_t leaf) const;
    glm::dvec3 bound(const Node& node, const Box& box) const;
    const Node& node(std::int64_t index) const { return nodes_[static_cast<std::size_t>(index)]; }
    std::vector<std::size_t> lights_of(const Node& node) const;

    std::vector<std::size_t> off_;         ///< indices of lights that give nothing
    std::vector<const RigLight*> leaves_;  ///< suns last
    std::vector<Node> nodes_;              ///< of the tree, then one for each sun
    std::size_t first_sun_ = 0;            ///< in nodes_
    std::int64_t root_ = -1;
};

}  // namespace skinglow::detail
