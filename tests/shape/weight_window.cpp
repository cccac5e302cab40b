#include "shape/weight_window.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace skinglow::testing {
namespace {

constexpr float never = std::numeric_limits<float>::infinity();

/// Photons lighter than this would be too many to follow.
constexpr double smallest_weight = 3e-6;

/// Of photons beyond the radius, and over which way they become so heavy.
constexpr double heaviest = 20.0;
constexpr double fading_mm = 3.0;

}  // namespace

WeightWindow::WeightWindow(std::span<const DimmedPoint> lit, std::span<const glm::dvec3> targets, double rate,
                           double radius_mm) {
    if (lit.empty() || targets.empty()) return;
    low_ = targets.front();
    glm::dvec3 high = low_;
    for (const glm::dvec3& target : targets) {
        low_ = glm::min(low_, target);
        high = glm::max(high, target);
    }
    // Beyond the radius fewer photons are followed, the farther, the fewer.
    low_ -= 2.0 * radius_mm;
    high += 2.0 * radius_mm;
    for (int axis = 0; axis < 3; ++axis)
        size_[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low_[axis]) / cell_mm_) + 1;
    const std::size_t cells = cell_of({size_[0] - 1, size_[1] - 1, size_[2] - 1}) + 1;

    std::vector<float> dimming(cells, never);
    std::vector<float> distance(cells, never);
    const auto seed = [&](std::vector<float>& field, const glm::dvec3& position, double value) {
        const std::array<int, 3> cell = at(position);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (cell[axis] < 0 || cell[axis] >= size_[axis]) return;
        }
        float& entry = field[cell_of(cell)];
        entry = std::min(entry, static_cast<float>(value));
    };
    for (const DimmedPoint& point : lit) seed(dimming, point.position, point.dimming);
    for (const glm::dvec3& target : targets) seed(distance, target, 0.0);
    spread(dimming, rate);
    spread(distance, 1.0);
    weight_.resize(cells);
    for (std::size_t i = 0; i < cells; ++i) {
        const double weight = std::clamp(std::exp(-static_cast<double>(dimming[i])), smallest_weight, 1.0);
        const double beyond = distance[i] - radius_mm;
        weight_[i] =
            static_cast<float>(beyond < 0 ? weight : std::min(heaviest, std::exp(beyond / fading_mm)));
    }
}

double WeightWindow::weight_at(const glm::dvec3& position) const {
    if (weight_.empty()) return 1.0;
    const std::array<int, 3> cell = at(position);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (cell[axis] < 0 || cell[axis] >= size_[axis]) return heaviest;
    }
    return weight_[cell_of(cell)];
}

std::size_t WeightWindow::cell_of(const std::array<int, 3>& at) const {
    const auto size = [](int n) { return static_cast<std::size_t>(n); };
    return (size(at[0]) * size(size_[1]) + size(at[1])) * size(size_[2]) + size(at[2]);
}

std::array<int, 3> WeightWindow::at(const glm::dvec3& position) const {
    const glm::dvec3 cell = glm::clamp(glm::floor((position - low_) / cell_mm_), -1.0, 1e6);
    return {static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
}

/// Chamfer distance, rate per mm, from all cells that have a value: one pass forward, one back.
void WeightWindow::spread(std::vector<float>& distance, double rate) const {
    std::vector<std::array<int, 4>> steps;  // the half of the neighbors that a forward pass has seen
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            for (int k = -1; k <= 1; ++k) {
                if (i * 9 + j * 3 + k < 0) steps.push_back({i, j, k, i * i + j * j + k * k});
            }
        }
    }
    for (const int sign : {1, -1}) {
        const auto start = [&](std::size_t axis) { return sign > 0 ? 0 : size_[axis] - 1; };
        const auto inside = [&](int i, std::size_t axis) { return i >= 0 && i < size_[axis]; };
        for (int i = start(0); inside(i, 0); i += sign) {
            for (int j = start(1); inside(j, 1); j += sign) {
                for (int k = start(2); inside(k, 2); k += sign) {
                    float& here = distance[cell_of({i, j, k})];
                    for (const auto& [di, dj, dk, square] : steps) {
                        const std::array<int, 3> from{i + sign * di, j + sign * dj, k + sign * dk};
                        if (!inside(from[0], 0) || !inside(from[1], 1) || !inside(from[2], 2)) continue;
                        const double way = rate * cell_mm_ * std::sqrt(square);
                        here = std::min(here, distance[cell_of(from)] + static_cast<float>(way));
                    }
                }
            }
        }
    }
}

}  // namespace skinglow::testing
