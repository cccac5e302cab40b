#include "radiometry/area_angular_weight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "numerics/quadrature.h"

namespace skinglow::detail {
namespace {

constexpr double narrow = 1.0 / 50.0;
constexpr double wide = 1.0 / 4.0;

using Nodes = std::vector<AreaAngularWeight::Node>;

Nodes rectangle_nodes(const PreparedLight& light, std::size_t across) {
    const Quadrature& rule = gauss_rule(across);
    Nodes nodes;
    for (std::size_t i = 0; i < across; ++i) {
        for (std::size_t j = 0; j < across; ++j)
            nodes.push_back({light.point_on_area(2 * rule.node[i] - 1, 2 * rule.node[j] - 1),
                             rule.weight[i] * rule.weight[j]});
    }
    return nodes;
}

// Area grows with the radius squared, in which the rule is Gauss's.
Nodes ellipse_nodes(const PreparedLight& light, std::size_t rings, int around) {
    const Quadrature& rule = gauss_rule(rings);
    Nodes nodes;
    for (std::size_t i = 0; i < rings; ++i) {
        const double radius = std::sqrt(rule.node[i]);
        for (int j = 0; j < around; ++j) {
            const double angle = 2.0 * std::numbers::pi * (j + 0.5) / around;
            nodes.push_back({light.point_on_area(radius * std::cos(angle), radius * std::sin(angle)),
                             rule.weight[i] / around});
        }
    }
    return nodes;
}

}  // namespace

AreaAngularWeight::AreaAngularWeight(const PreparedLight& light, const AngularWeight& angular_weight)
    : light_(light), angular_weight_(angular_weight) {
    const bool is_ellipse = light.area()->shape() == AreaShape::ellipse;
    few_ = is_ellipse ? ellipse_nodes(light, 1, 4) : rectangle_nodes(light, 2);
    many_ = is_ellipse ? ellipse_nodes(light, 4, 8) : rectangle_nodes(light, 6);
}

glm::dvec3 AreaAngularWeight::mean(const glm::dvec3& point, const glm::dvec3& normal) const {
    const double distance = light_.distance(point);
    const glm::dvec3 at_center = angular_weight_.at(glm::dot(light_.to_light(point), normal));
    if (!(light_.radius() > narrow * distance)) return at_center;
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for (const Node& node : light_.radius() > wide * distance ? many_ : few_) {
        const glm::dvec3 offset = node.position - point;
        const double height = -glm::dot(offset, light_.direction());
        const double height_over_horizon = glm::dot(offset, normal);
        if (!(height > 0.0) || !(height_over_horizon > 0.0)) continue;
        const double length = glm::length(offset);
        const double foot_distance = std::sqrt(std::max(0.0, (length - height) * (length + height)));
        // In units of the distance to the center: near or far, nothing over- or underflows.
        const double ratio = distance / length;
        const double light = node.fraction * light_.area()->gain(foot_distance / height) *
                             (height_over_horizon / length) * (height / length) * ratio * ratio;
        sum += light * angular_weight_.at(height_over_horizon / length);
        total += light;
    }
    return total > 0.0 && std::isfinite(total) ? sum / total : at_center;
}

}  // namespace skinglow::detail
