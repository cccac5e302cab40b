#include "shape/site_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "numerics/job.h"
#include "shape/space_blocks.h"

namespace skinglow::detail {
namespace {

using Group = std::vector<std::uint32_t>;

/// Longest edge of a group's box, in margins: flesh that two parts share makes a third of the work there.
constexpr double max_extent = 12;
/// Where a group may be cut, from either end, in parts of its length.
constexpr double cut_from = 0.25;
/// Positions that are tried, in margins.
constexpr double cut_step = 0.25;

/// What hangs together by neighboring blocks.
std::vector<Group> connected(const Body& body, const SurfaceSites& sites,
                             std::span<const std::uint32_t> chosen, double margin) {
    SpaceBlocks blocks(margin);
    for (const std::uint32_t i : chosen) {
        stop_if_asked(i);
        for (const glm::vec3& p : sites.spread(body, sites.sites()[i], static_cast<float>(margin)))
            blocks.add(p, i);
    }
    std::vector<Group> groups;
    SpaceBlocks::Keys visited;
    std::vector<std::uint8_t> seen(sites.sites().size(), 0);
    for (const std::uint32_t first : chosen) {
        if (seen[first] != 0) continue;
        Group group;
        std::vector<glm::dvec3> open{blocks.key(sites.sites()[first].position)};
        visited.insert(open.front());
        for (std::size_t next = 0; next < open.size(); ++next) {
            const glm::dvec3 middle = open[next];
            blocks.visit_about(middle, [&](const glm::dvec3& key, const Group& items) {
                if (key == middle) {
                    for (const std::uint32_t i : items) {
                        if (seen[i] == 0) group.push_back(i);
                        seen[i] = 1;
                    }
                } else if (visited.insert(key).second) {
                    open.push_back(key);
                }
            });
        }
        groups.push_back(std::move(group));
    }
    return groups;
}

struct Cut {
    int axis;
    double position;
};

/// The plane that the fewest sites lie within a margin of; none where the group is short.
std::optional<Cut> best_cut(const SurfaceSites& sites, const Group& group, double margin) {
    std::optional<Cut> best;
    auto fewest = std::numeric_limits<std::ptrdiff_t>::max();
    std::vector<double> along(group.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(group.begin(), group.end(), along.begin(),
                       [&](std::uint32_t i) { return static_cast<double>(sites.sites()[i].position[axis]); });
        std::sort(along.begin(), along.end());
        const double length = along.back() - along.front();
        if (length <= max_extent * margin) continue;
        const auto steps = static_cast<int>(std::min(1000.0, length / (cut_step * margin)));
        for (int s = 0; s <= steps; ++s) {
            const double part = cut_from + (1 - 2 * cut_from) * s / steps;
            const double position = along.front() + part * length;
            const auto above = std::lower_bound(along.begin(), along.end(), position - margin);
            const auto shared = std::upper_bound(above, along.end(), position + margin) - above;
            if (shared >= fewest) continue;
            fewest = shared;
            best = Cut{axis, position};
        }
    }
    return best;
}

}  // namespace

std::vector<Group> site_groups(const Body& body, const SurfaceSites& sites,
                               std::span<const std::uint32_t> chosen, double margin) {
    std::vector<Group> done;
    std::vector<Group> open = connected(body, sites, chosen, margin);
    while (!open.empty()) {
        Group group = std::move(open.back());
        open.pop_back();
        const std::optional<Cut> cut = best_cut(sites, group, margin);
        if (!cut) {
            done.push_back(std::move(group));
            continue;
        }
        const auto middle = std::partition(group.begin(), group.end(), [&](std::uint32_t i) {
            return static_cast<double>(sites.sites()[i].position[cut->axis]) < cut->position;
        });
        open.emplace_back(middle, group.end());
        open.emplace_back(group.begin(), middle);
    }
    std::sort(done.begin(), done.end(), [](const Group& a, const Group& b) {
        return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
    });
    return done;
}

}  // namespace skinglow::detail
