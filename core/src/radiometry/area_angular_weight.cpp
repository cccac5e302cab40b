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

/// A point on the light, in units of its half axes, and its fraction of the area.
struct Part {
    double x, y, fraction;
};

template <std::size_t Across>
std::vector<Part> rectangle_rule() {
    const Quadrature& rule = gauss_legendre<Across>();
    std::vector<Part> parts;
    for (std::size_t i = 0; i < Across; ++i) {
        for (std::size_t j = 0; j < Across; ++j) {
            parts.push_back({2 * rule.node[i] - 1, 2 * rule.node[j] - 1, rule.weight[i] * rule.weight[j]});
        }
    }
    return parts;
}

// Area grows with the radius squared, in which the rule is Gauss's.
template <std::size_t Rings>
std::vector<Part> ellipse_rule(int around) {
    const Quadrature& rule = gauss_legendre<Rings>();
    std::vector<Part> parts;
    for (std::size_t i = 0; i < Rings; ++i) {
        const double radius = std::sqrt(rule.node[i]);
        for (int j = 0; j < around; ++j) {
            const double angle = 2.0 * std::numbers::pi * (j + 0.5) / around;
            parts.push_back({radius * std::cos(angle), radius * std::sin(angle), rule.weight[i] / around});
        }
    }
    return parts;
}

}  // namespace

AreaAngularWeight::AreaAngularWeight(const PreparedLight& light, const AngularWeight& angular_weight)
    : light_(light), angular_weight_(angular_weight) {
    const AreaEmitter& area = *light.area();
    half_diagonal_ = std::hypot(area.half_x(), area.half_y()) * light.area_scale();
    const bool is_ellipse = area.shape() == AreaShape::ellipse;
    const auto placed = [&](const std::vector<Part>& parts) {
        Nodes nodes;
        for (const Part& part : parts) {
            nodes.push_back(
                {light.position() + light.area_scale() * (part.x * area.half_x() * light.frame()[0] +
                                                          part.y * area.half_y() * light.frame()[1]),
                 part.fraction});
        }
        return nodes;
    };
    few_ = placed(is_ellipse ? ellipse_rule<1>(4) : rectangle_rule<2>());
    many_ = placed(is_ellipse ? ellipse_rule<4>(8) : rectangle_rule<6>());
}

glm::dvec3 AreaAngularWeight::mean(const glm::dvec3& point, const glm::dvec3& normal) const {
    const double distance = light_.distance(point);
    const glm::dvec3 at_middle = angular_weight_.at(glm::dot(light_.to_light(point), normal));
    if (!(half_diagonal_ > narrow * distance)) return at_middle;
    glm::dvec3 sum(0.0);
    double whole = 0.0;
    for (const Node& node : half_diagonal_ > wide * distance ? many_ : few_) {
        const glm::dvec3 towards = node.position - point;
        const double height = -glm::dot(towards, light_.direction());
        const double height_over_horizon = glm::dot(towards, normal);
        if (!(height > 0.0) || !(height_over_horizon > 0.0)) continue;
        const double length = glm::length(towards);
        const double sideways = std::sqrt(std::max(0.0, (length - height) * (length + height)));
        // In units of the distance to the center: near or far, nothing over- or underflows.
        const double ratio = distance / length;
        const double light = node.fraction * light_.area()->gain(sideways / height) *
                             (height_over_horizon / length) * (height / length) * ratio * ratio;
        sum += light * angular_weight_.at(height_over_horizon / length);
        whole += light;
    }
    return whole > 0.0 && std::isfinite(whole) ? sum / whole : at_middle;
}

}  // namespace skinglow::detail
