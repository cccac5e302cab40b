#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "geometry/weld.h"

namespace skinglow::detail {

/// Items by cubes of space.
class SpaceBlocks {
  public:
    /// @param edge  of the cubes, mm, above 0
    explicit SpaceBlocks(double edge) : edge_(edge) {}

    glm::dvec3 key(const glm::vec3& p) const { return glm::floor(glm::dvec3(p) / edge_); }

    void add(const glm::vec3& p, std::uint32_t item) {
        std::vector<std::uint32_t>& items = of_[key(p)];
        if (items.empty() || items.back() != item) items.push_back(item);
    }

    const std::vector<std::uint32_t>* find(const glm::dvec3& key) const {
        const auto found = of_.find(key);
        return found == of_.end() ? nullptr : &found->second;
    }

    /// Calls `visit(key, items)` for a block and the 26 about it, as far as they hold something.
    template <typename Visit>
    void visit_about(glm::dvec3 middle, const Visit& visit) const {
        for (int n = 0; n < 27; ++n) {
            const glm::dvec3 next = middle + glm::dvec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
            if (const auto* items = find(next)) visit(next, *items);
        }
    }

    struct Hash {
        std::size_t operator()(const glm::dvec3& v) const { return hash_of(v); }
    };
    using Keys = std::unordered_set<glm::dvec3, Hash>;

  private:
    double edge_;
    std::unordered_map<glm::dvec3, std::vector<std::uint32_t>, Hash> of_;
};

/// Distance to the nearest of many points, as far as it is below a limit, to a quarter of it: of points that
/// lie closer together one stands for the others, so that a dense mesh costs no more than a coarse one.
class NearestDistance {
  public:
    explicit NearestDistance(double limit) : limit_(limit), blocks_(limit), fine_(0.25 * limit) {}

    void add(const glm::vec3& p) {
        if (!taken_.insert(fine_.key(p)).second) return;
        blocks_.add(p, static_cast<std::uint32_t>(points_.size()));
        points_.push_back(p);
    }

    /// Infinite beyond the limit.
    double operator()(const glm::vec3& p) const {
        float least_sq = std::numeric_limits<float>::infinity();
        blocks_.visit_about(blocks_.key(p), [&](const glm::dvec3&, const std::vector<std::uint32_t>& items) {
            for (const std::uint32_t i : items) {
                const glm::vec3 off = points_[i] - p;
                least_sq = glm::min(least_sq, glm::dot(off, off));
            }
        });
        const double distance = glm::sqrt(static_cast<double>(least_sq));
        return distance < limit_ ? distance : std::numeric_limits<double>::infinity();
    }

  private:
    double limit_;
    SpaceBlocks blocks_;
    SpaceBlocks fine_;
    SpaceBlocks::Keys taken_;
    std::vector<glm::vec3> points_;
};

}  // namespace skinglow::detail
