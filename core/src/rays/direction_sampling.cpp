#include "rays/direction_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinglow::detail {

namespace {

/// pi (3 - sqrt 5): an angle between successive points that keeps every ring apart from the last.
const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));

glm::dvec3 on_spiral(int index, double radius, double height) {
    return {radius * std::cos(golden_angle * index), radius * std::sin(golden_angle * index), height};
}

}  // namespace

std::vector<glm::dvec3> cone_directions(int count, double half_angle) {
    const double cap_height = 1.0 - std::cos(half_angle);
    std::vector<glm::dvec3> directions(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // Equal steps of height are equal areas of the sphere; the root makes the density fall to 0 along
        // them.
        const double depth = cap_height * (1.0 - std::sqrt(1.0 - static_cast<double>(i) / count));
        directions[static_cast<std::size_t>(i)] = on_spiral(i, std::sqrt(depth * (2.0 - depth)), 1.0 - depth);
    }
    return directions;
}

std::vector<glm::dvec3> cosine_directions(int count) {
    std::vector<glm::dvec3> directions(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // Equal areas of the disc below (Nusselt's analogue).
        const double radius_sq = (i + 0.5) / count;
        directions[static_cast<std::size_t>(i)] =
            on_spiral(i, std::sqrt(radius_sq), std::sqrt(1 - radius_sq));
    }
    return directions;
}

double interquartile_mean(std::span<WeightedValue> samples) {
    std::sort(samples.begin(), samples.end(), [](const WeightedValue& a, const WeightedValue& b) {
        return a.value < b.value || (a.value == b.value && a.weight < b.weight);
    });
    double total = 0;
    for (const WeightedValue& sample : samples) total += sample.weight;
    const double low = 0.25 * total;
    const double high = 0.75 * total;
    double below = 0;
    double sum = 0;
    double inside = 0;
    for (const WeightedValue& sample : samples) {
        const double above = below + sample.weight;
        const double weight = std::max(0.0, std::min(above, high) - std::max(below, low));
        sum += weight * sample.value;
        inside += weight;
        below = above;
    }
    return sum / inside;
}

}  // namespace skinglow::detail
