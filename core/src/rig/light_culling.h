#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "light/light.h"
#include "rig/light_bounds.h"

namespace skinglow {

/// Why lamps are left out for an object.
enum class DropReason {
    off,          ///< hidden, power 0, black, or a cone or spread of no width
    unreachable,  ///< the whole box is behind them or outside their cones: they give nothing
    negligible,   ///< together with all other dropped lamps within the tolerance
};

/// "off", "unreachable" or "negligible".
std::string_view to_text(DropReason reason);

/// Lamps left out together, and what they can give at most, W/m^2 of each channel, at any point of the box
/// for any normal.
struct DroppedLights {
    std::vector<std::size_t> lights;  ///< indices, ascending
    DropReason reason;
    glm::dvec3 bound;
};

struct CullingResult {
    std::vector<std::size_t> kept;       ///< indices of the lamps that count, ascending
    std::vector<DroppedLights> dropped;  ///< every other lamp, in one group each
    glm::dvec3 bound{0.0};               ///< sum of the groups' bounds: at most the tolerance
};

/// Lamps in a binary tree over their positions, so that for each object only those are looked at that may
/// matter. A node knows the box its lamps stand in, the most they can give together, and a cone that holds
/// all that they shine into (as in A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", HPG 2018, where such nodes serve sampling; here they bound what is left out).
class LightTree {
  public:
    /// O(n log n). Throws std::invalid_argument on a bad lamp.
    explicit LightTree(std::span<const Light> lights);

    std::size_t size() const { return count_; }

    /// Leaves out lamps whose sum changes no channel of the irradiance by more than the tolerance, at any
    /// point of the box, whatever the normal: proven by irradiance_range, with negative power counted at its
    /// size. Starts with the whole tree left out and takes back the group with the largest bound until the
    /// rest is within the tolerance: the work goes with the lamps that matter, not with all.
    /// @param tolerance  W/m^2, finite, 0 or more (0 leaves out only what gives nothing). Else
    /// std::invalid_argument.
    CullingResult cull(const Box& box, double tolerance) const;

  private:
    struct Leaf {
        std::size_t index;
        PreparedLight light;
        glm::dvec3 strength;  ///< |power| * color
    };
    struct Node {
        std::size_t begin, end;  ///< leaves of it, in leaves_
        std::int64_t left = -1;  ///< -1: one leaf; the right child follows the left's
        std::int64_t right = -1;
        Box extent;                  ///< all that glows
        glm::dvec3 per_square{0.0};  ///< sum of what a lamp gives at most at a distance of 1
        glm::dvec3 anywhere{0.0};    ///< sum of what a lamp gives at most at any distance
        glm::dvec3 axis{0.0, 0.0, 1.0};
        double half_angle = 0;  ///< of the cone they shine into; pi: everywhere
    };

    std::int64_t build(std::size_t begin, std::size_t end);
    Node node_of_leaf(std::size_t place) const;
    glm::dvec3 bound(const Node& node, const Box& box) const;

    std::size_t count_;
    std::vector<std::size_t> off_;
    std::vector<Leaf> leaves_;   ///< suns last
    std::vector<Node> nodes_;    ///< of the tree, then one for each sun
    std::size_t first_sun_ = 0;  ///< in nodes_
    std::int64_t root_ = -1;
};

/// Lamps with the same place, shape and direction as one lamp each, their light added: exact to rounding. For
/// scenes that stack lamps. @return in order of first appearance; lamps that are off are left out. The name
/// is the first one's.
std::vector<Light> merge_identical(std::span<const Light> lights);

}  // namespace skinglow
