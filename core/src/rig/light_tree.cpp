#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/light_bounds.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace detail {

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
    static constexpr std::size_t no_node = std::numeric_limits<std::size_t>::max();
    struct Node {
        std::size_t begin, end;      ///< leaves of it, in leaves_
        std::size_t left = no_node;  ///< no_node: one leaf
        std::size_t right = no_node;
        Box extent;                   ///< all that glows
        glm::dvec3 at_distance{0.0};  ///< sum of upper bounds at a distance of 1
        glm::dvec3 anywhere{0.0};     ///< sum of upper bounds at any distance
        NormalCone cone;              ///< that they shine into
    };

    std::size_t build(std::size_t begin, std::size_t end);
    Node node_of_leaf(std::size_t leaf) const;
    glm::dvec3 bound(const Node& node, const Box& box) const;
    std::vector<std::size_t> lights_of(const Node& node) const;

    std::vector<std::size_t> off_;         ///< indices of lights that give nothing
    std::vector<const RigLight*> leaves_;  ///< suns last
    std::vector<Node> nodes_;              ///< of the tree, then one for each sun
    std::size_t first_sun_ = 0;            ///< in nodes_
    std::size_t root_ = no_node;
};

namespace {

using std::numbers::pi;

/// The smallest cone around two; grown a little, so that rounding leaves nothing out.
NormalCone cone_around(const NormalCone& a, const NormalCone& b) {
    const double between = angle_between(a.axis, b.axis);
    if (between + b.half_angle <= a.half_angle) return a;
    if (between + a.half_angle <= b.half_angle) return b;
    const double wide = 0.5 * (a.half_angle + between + b.half_angle) + 1e-9;
    const glm::dvec3 across = b.axis - glm::dot(a.axis, b.axis) * a.axis;
    if (wide >= pi || length(across) < 1e-9) return {a.axis, pi};
    const double turn = wide - a.half_angle;
    return {unit(std::cos(turn) * a.axis + std::sin(turn) * unit(across)), wide};
}

glm::dvec3 position(const RigLight* leaf) {
    return leaf->light.position();
}

struct Candidate {
    double key;  ///< largest channel of the bound
    std::size_t node;
    glm::dvec3 bound;
    bool operator<(const Candidate& other) const { return key < other.key; }
};

/// Nodes that are culled, the largest bound on top, and the sum of their bounds.
class Culled {
  public:
    void add(std::size_t node, const glm::dvec3& bound) {
        candidates_.push_back({max_abs(bound), node, bound});
        std::push_heap(candidates_.begin(), candidates_.end());
        total_ += bound;
        peak_ = std::max(peak_, max_abs(total_));
    }

    Candidate take_largest() {
        std::pop_heap(candidates_.begin(), candidates_.end());
        const Candidate top = candidates_.back();
        candidates_.pop_back();
        total_ -= top.bound;
        return top;
    }

    /// Whether the sum is above the tolerance and something can be taken back. Nodes with lights inside the
    /// box have bounds many decades above what remains when they are gone, and rounding of that size: then
    /// the sum is made anew.
    bool exceeds(double tolerance) {
        if (candidates_.empty() || candidates_.front().key == 0.0) {
            total_ = glm::dvec3(0.0);
            return false;
        }
        const double total = max_abs(total_);
        if (!(total > 1e-6 * peak_) || total <= tolerance) {
            CompensatedSumRgb sum;
            for (const Candidate& candidate : candidates_) sum.add(candidate.bound);
            total_ = sum.total();
            peak_ = max_abs(total_);
        }
        return !(max_abs(total_) <= tolerance);
    }

    const std::vector<Candidate>& candidates() const { return candidates_; }
    const glm::dvec3& total() const { return total_; }

  private:
    std::vector<Candidate> candidates_;
    glm::dvec3 total_{0.0};
    double peak_ = 0;
};

}  // namespace

LightTree::LightTree(std::span<const RigLight> lights) {
    for (const RigLight& one : lights) {
        if (one.shines) {
            leaves_.push_back(&one);
        } else {
            off_.push_back(one.index);
        }
    }
    const auto suns = std::stable_partition(leaves_.begin(), leaves_.end(), [](const RigLight* leaf) {
        return leaf->light.kind() != LightKind::sun;
    });
    const auto sun_begin = static_cast<std::size_t>(suns - leaves_.begin());
    nodes_.reserve(2 * leaves_.size());
    if (sun_begin > 0) root_ = build(0, sun_begin);
    first_sun_ = nodes_.size();
    for (std::size_t i = sun_begin; i < leaves_.size(); ++i) nodes_.push_back(node_of_leaf(i));
}

LightTree::Node LightTree::node_of_leaf(std::size_t leaf) const {
    const PreparedLight& light = leaves_[leaf]->light;
    Node node{.begin = leaf, .end = leaf + 1, .extent = {}, .cone = {}};
    glm::dvec3 extent(light.radius());
    double at_distance = 0.25 / pi;
    double anywhere = 0.25 / pi / std::pow(std::max(light.radius(), min_light_distance), 2);
    node.cone = {light.direction(), pi};
    if (light.kind() == LightKind::spot) node.cone.half_angle = light.spot()->edge() + 1e-9;
    if (light.kind() == LightKind::area) {
        const AreaEmitter& area = *light.area();
        const double scale = light.area_scale();
        // Heights over the light are clamped to a minimum: as if it stood that much nearer.
        extent = half_extent(light) + glm::dvec3(min_light_distance + 2e-9 * scale);
        at_distance = area.axis_gain() / pi;
        anywhere = area.axis_gain() / area.area() / scale / scale;
        node.cone.half_angle = std::min(pi, area.half_spread() + 1e-9);
    }
    node.extent = {light.position() - extent, light.position() + extent};
    node.at_distance = glm::abs(leaves_[leaf]->scaled(at_distance));
    node.anywhere = glm::abs(leaves_[leaf]->scaled(anywhere));
    return node;
}

std::size_t LightTree::build(std::size_t begin, std::size_t end) {
    if (end - begin == 1) {
        nodes_.push_back(node_of_leaf(begin));
        return nodes_.size() - 1;
    }
    Box box{position(leaves_[begin]), position(leaves_[begin])};
    for (std::size_t i = begin; i < end; ++i) {
        box = {glm::min(box.min, position(leaves_[i])), glm::max(box.max, position(leaves_[i]))};
    }
    const glm::dvec3 size = box.half_extent();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t median = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return leaves_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(median), at(end), [axis](const RigLight* a, const RigLight* b) {
        return position(a)[axis] < position(b)[axis];
    });
    const std::size_t left = build(begin, median);
    const std::size_t right = build(median, end);
    const Node& a = nodes_[left];
    const Node& b = nodes_[right];
    nodes_.push_back({.begin = begin,
                      .end = end,
                      .left = left,
                      .right = right,
                      .extent = {glm::min(a.extent.min, b.extent.min), glm::max(a.extent.max, b.extent.max)},
                      .at_distance = a.at_distance + b.at_distance,
                      .anywhere = a.anywhere + b.anywhere,
                      .cone = cone_around(a.cone, b.cone)});
    return nodes_.size() - 1;
}

glm::dvec3 LightTree::bound(const Node& node, const Box& box) const {
    if (node.left == no_node) {
        const RigLight& leaf = *leaves_[node.begin];
        return glm::abs(leaf.scaled(irradiance_range(leaf.light, box).max));
    }
    const double gap = distance_between(node.extent, box) * (1 - 1e-9);
    const glm::dvec3 anywhere = node.anywhere * (1 + 1e-6);
    if (gap == 0.0) return anywhere;
    const double radius = box.radius() + node.extent.radius();
    if (min_angle(node.cone.axis, box.center() - node.extent.center(), radius) > node.cone.half_angle + 1e-9)
        return glm::dvec3(0.0);
    return glm::min(node.at_distance * ((1 + 1e-6) / gap / gap), anywhere);
}

std::vector<std::size_t> LightTree::lights_of(const Node& node) const {
    std::vector<std::size_t> lights;
    for (std::size_t i = node.begin; i < node.end; ++i) lights.push_back(leaves_[i]->index);
    std::sort(lights.begin(), lights.end());
    return lights;
}

CullingResult LightTree::cull(const Box& box, double tolerance) const {
    validate(box);
    require_not_negative("tolerance", tolerance);
    Culled culled;
    const auto add = [&](std::size_t node) { culled.add(node, bound(nodes_[node], box)); };
    if (root_ != no_node) add(root_);
    for (std::size_t i = first_sun_; i < nodes_.size(); ++i) add(i);

    CullingResult result;
    while (culled.exceeds(tolerance * (1 - 1e-12))) {
        const Node& largest = nodes_[culled.take_largest().node];
        if (largest.left == no_node) {
            result.kept.push_back(leaves_[largest.begin]->index);
        } else {
            add(largest.left);
            add(largest.right);
        }
    }
    std::sort(result.kept.begin(), result.kept.end());
    result.bound = culled.total();
    if (!off_.empty()) result.dropped.push_back({off_, DropReason::off, glm::dvec3(0.0)});
    for (const Candidate& candidate : culled.candidates()) {
        const DropReason reason = candidate.key > 0.0 ? DropReason::negligible : DropReason::unreachable;
        result.dropped.push_back({lights_of(nodes_[candidate.node]), reason, candidate.bound});
    }
    return result;
}

const LightTree& RigData::tree() const {
    std::call_once(tree_made_, [this] { tree_ = std::make_shared<const LightTree>(prepared); });
    return *tree_;
}

}  // namespace detail

std::string_view to_text(DropReason reason) {
    constexpr std::array<std::string_view, 3> names = {"off", "unreachable", "negligible"};
    return names.at(static_cast<std::size_t>(reason));
}

CullingResult PreparedRig::cull(const Box& box, double tolerance) const {
    return data_->tree().cull(box, tolerance);
}

}  // namespace skinglow
