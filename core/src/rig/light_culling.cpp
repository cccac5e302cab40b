#include "rig/light_culling.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>

#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;

double largest_channel(const glm::dvec3& v) {
    return std::max({v.r, v.g, v.b});
}

/// The smallest cone around two; grown a little, so that rounding leaves nothing out.
void widen_cone(glm::dvec3& axis, double& half_angle, const glm::dvec3& other_axis, double other_half_angle) {
    const double apart = std::atan2(glm::length(glm::cross(axis, other_axis)), glm::dot(axis, other_axis));
    if (apart + other_half_angle <= half_angle) return;
    if (apart + half_angle <= other_half_angle) {
        axis = other_axis;
        half_angle = other_half_angle;
        return;
    }
    const double wide = 0.5 * (half_angle + apart + other_half_angle) + 1e-9;
    const double turn = wide - half_angle;
    const glm::dvec3 across = other_axis - glm::dot(axis, other_axis) * axis;
    if (wide >= pi || glm::length(across) < 1e-9) {
        half_angle = pi;
        return;
    }
    axis = glm::normalize(std::cos(turn) * axis + std::sin(turn) * glm::normalize(across));
    half_angle = wide;
}

struct Candidate {
    double key;  ///< largest channel of the bound
    std::int64_t node;
    glm::dvec3 bound;
    bool operator<(const Candidate& other) const { return key < other.key; }
};

/// Groups that are left out, the largest bound on top, and the sum of their bounds.
class LeftOut {
  public:
    void add(std::int64_t node, const glm::dvec3& bound) {
        candidates_.push_back({largest_channel(bound), node, bound});
        std::push_heap(candidates_.begin(), candidates_.end());
        total_ += bound;
        peak_ = std::max(peak_, largest_channel(total_));
    }

    Candidate take_largest() {
        std::pop_heap(candidates_.begin(), candidates_.end());
        const Candidate top = candidates_.back();
        candidates_.pop_back();
        total_ -= top.bound;
        return top;
    }

    /// Whether the sum is above the tolerance and something can be taken back. Groups with lamps inside the
    /// box have bounds many decades above what remains when they are gone, and rounding of that size: then
    /// the sum is made anew.
    bool exceeds(double tolerance) {
        if (candidates_.empty() || candidates_.front().key == 0.0) {
            total_ = glm::dvec3(0.0);
            return false;
        }
        const double total = largest_channel(total_);
        if (!(total > 1e-6 * peak_) || total <= tolerance) {
            add_up();
            peak_ = largest_channel(total_);
        }
        return !(largest_channel(total_) <= tolerance);
    }

    const std::vector<Candidate>& candidates() const { return candidates_; }
    const glm::dvec3& total() const { return total_; }

  private:
    void add_up() {
        CompensatedSumRgb sum;
        for (const Candidate& candidate : candidates_) sum.add(candidate.bound);
        total_ = sum.total();
    }

    std::vector<Candidate> candidates_;
    glm::dvec3 total_{0.0};
    double peak_ = 0;
};

}  // namespace

std::string_view to_text(DropReason reason) {
    switch (reason) {
        case DropReason::off:
            return "off";
        case DropReason::unreachable:
            return "unreachable";
        case DropReason::negligible:
            return "negligible";
    }
    refuse_argument("drop reason", std::to_string(static_cast<int>(reason)),
                    "off, unreachable or negligible");
}

LightTree::LightTree(std::span<const Light> lights) : count_(lights.size()) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        validate(light);
        PreparedLight prepared(light);
        if (!is_on(light) || prepared.dark()) {
            off_.push_back(i);
        } else {
            leaves_.push_back({i, prepared, light.color * std::abs(light.power)});
        }
    }
    const auto suns = std::stable_partition(
        leaves_.begin(), leaves_.end(), [](const Leaf& leaf) { return leaf.light.kind() != LightKind::sun; });
    const auto sun_begin = static_cast<std::size_t>(suns - leaves_.begin());
    nodes_.reserve(2 * leaves_.size());
    if (sun_begin > 0) root_ = build(0, sun_begin);
    first_sun_ = nodes_.size();
    for (std::size_t i = sun_begin; i < leaves_.size(); ++i) nodes_.push_back(node_of_leaf(i));
}

LightTree::Node LightTree::node_of_leaf(std::size_t place) const {
    const Leaf& leaf = leaves_[place];
    const PreparedLight& light = leaf.light;
    Node node{.begin = place, .end = place + 1, .extent = {}};
    glm::dvec3 extent(light.radius());
    double per_square = 0.25 / pi;
    double anywhere = 0.25 / pi / std::pow(std::max(light.radius(), min_light_distance), 2);
    node.half_angle = pi;
    if (light.kind() == LightKind::spot) node.half_angle = light.spot()->edge() + 1e-9;
    if (light.kind() == LightKind::area) {
        const AreaEmitter& area = *light.area();
        const double scale = light.area_scale();
        extent =
            scale * (glm::abs(light.frame()[0]) * area.half_x() + glm::abs(light.frame()[1]) * area.half_y());
        // Heights over the lamp are held above a minimum: as if it stood that much nearer.
        extent += glm::dvec3(min_light_distance + 2e-9 * scale);
        per_square = area.axis_gain() / pi;
        anywhere = area.axis_gain() / area.area() / scale / scale;
        node.half_angle = std::min(pi, area.half_spread() + 1e-9);
    }
    node.axis = light.direction();
    node.extent = {light.position() - extent, light.position() + extent};
    node.per_square = leaf.strength * per_square;
    node.anywhere = leaf.strength * anywhere;
    return node;
}

std::int64_t LightTree::build(std::size_t begin, std::size_t end) {
    if (end - begin == 1) {
        nodes_.push_back(node_of_leaf(begin));
        return static_cast<std::int64_t>(nodes_.size()) - 1;
    }
    glm::dvec3 least = leaves_[begin].light.position();
    glm::dvec3 most = least;
    for (std::size_t i = begin; i < end; ++i) {
        least = glm::min(least, leaves_[i].light.position());
        most = glm::max(most, leaves_[i].light.position());
    }
    const glm::dvec3 size = 0.5 * most - 0.5 * least;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return leaves_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Leaf& a, const Leaf& b) {
        return a.light.position()[axis] < b.light.position()[axis];
    });
    const std::int64_t left = build(begin, middle);
    const std::int64_t right = build(middle, end);
    const Node& a = nodes_[static_cast<std::size_t>(left)];
    const Node& b = nodes_[static_cast<std::size_t>(right)];
    Node node{.begin = begin, .end = end, .left = left, .right = right, .extent = {}};
    node.extent = {glm::min(a.extent.min, b.extent.min), glm::max(a.extent.max, b.extent.max)};
    node.per_square = a.per_square + b.per_square;
    node.anywhere = a.anywhere + b.anywhere;
    node.axis = a.axis;
    node.half_angle = a.half_angle;
    widen_cone(node.axis, node.half_angle, b.axis, b.half_angle);
    nodes_.push_back(node);
    return static_cast<std::int64_t>(nodes_.size()) - 1;
}

glm::dvec3 LightTree::bound(const Node& node, const Box& box) const {
    if (node.left < 0) {
        const Leaf& leaf = leaves_[node.begin];
        return leaf.strength * irradiance_range(leaf.light, box).max;
    }
    const double reach = box.radius() + node.extent.radius();
    if (min_angle(node.axis, box.center() - node.extent.center(), reach) > node.half_angle + 1e-9)
        return glm::dvec3(0.0);
    const glm::dvec3 gap =
        glm::max(glm::max(node.extent.min - box.max, box.min - node.extent.max), glm::dvec3(0.0));
    const double near = std::hypot(gap.x, gap.y, gap.z) * (1 - 1e-9);
    const glm::dvec3 anywhere = node.anywhere * (1 + 1e-6);
    if (near == 0.0) return anywhere;
    return glm::min(node.per_square * ((1 + 1e-6) / near / near), anywhere);
}

CullingResult LightTree::cull(const Box& box, double tolerance) const {
    validate(box);
    require_not_negative("tolerance", tolerance);
    LeftOut left_out;
    const auto leave_out = [&](std::int64_t node) {
        left_out.add(node, bound(nodes_[static_cast<std::size_t>(node)], box));
    };
    if (root_ >= 0) leave_out(root_);
    for (std::size_t i = first_sun_; i < nodes_.size(); ++i) leave_out(static_cast<std::int64_t>(i));

    CullingResult result;
    while (left_out.exceeds(tolerance * (1 - 1e-12))) {
        const Node& node = nodes_[static_cast<std::size_t>(left_out.take_largest().node)];
        if (node.left < 0) {
            result.kept.push_back(leaves_[node.begin].index);
        } else {
            leave_out(node.left);
            leave_out(node.right);
        }
    }
    std::sort(result.kept.begin(), result.kept.end());
    result.bound = left_out.candidates().empty() ? glm::dvec3(0.0) : left_out.total();
    if (!off_.empty()) result.dropped.push_back({off_, DropReason::off, glm::dvec3(0.0)});
    for (const Candidate& candidate : left_out.candidates()) {
        const Node& node = nodes_[static_cast<std::size_t>(candidate.node)];
        DroppedLights group{
            {}, candidate.key > 0.0 ? DropReason::negligible : DropReason::unreachable, candidate.bound};
        for (std::size_t i = node.begin; i < node.end; ++i) group.lights.push_back(leaves_[i].index);
        std::sort(group.lights.begin(), group.lights.end());
        result.dropped.push_back(std::move(group));
    }
    return result;
}

std::vector<Light> merge_identical(std::span<const Light> lights) {
    const auto geometry = [](const Light& l) {
        return std::tuple(l.kind, l.position.x, l.position.y, l.position.z, l.direction.x, l.direction.y,
                          l.direction.z, l.radius, l.soft_falloff, l.sun_angle, l.spot_angle, l.spot_blend,
                          l.spot_cosine, l.area_shape, l.size_x, l.size_y, l.tangent.x, l.tangent.y,
                          l.tangent.z, l.spread);
    };
    struct Stack {
        Light light;
        CompensatedSumRgb positive, negative;
    };
    std::map<decltype(geometry(Light{})), std::size_t> known;
    std::vector<Stack> stacks;
    for (const Light& light : lights) {
        validate(light);
        if (!is_on(light)) continue;
        const auto [entry, is_new] = known.try_emplace(geometry(light), stacks.size());
        if (is_new) stacks.push_back({light, {}, {}});
        Stack& stack = stacks[entry->second];
        (light.power > 0 ? stack.positive : stack.negative).add(light.color * light.power);
    }
    std::vector<Light> merged;
    // A color is 0 or more in each channel: what takes light away stays a lamp of its own.
    for (const Stack& stack : stacks) {
        for (const glm::dvec3& strength : {stack.positive.total(), stack.negative.total()}) {
            const double size = std::max({std::abs(strength.r), std::abs(strength.g), std::abs(strength.b)});
            if (size == 0.0) continue;
            require_finite("sum of merged lights", size);
            Light light = stack.light;
            light.power = strength.r + strength.g + strength.b < 0.0 ? -size : size;
            light.color = strength / light.power;
            merged.push_back(light);
        }
    }
    return merged;
}

}  // namespace skinglow
