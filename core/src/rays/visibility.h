#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "light/light.h"
#include "rays/occluders.h"

namespace skinglow {

struct VisibilityOptions {
    /// Ways from a place to a lamp that has an extent, 1 to 4096; one goes to a lamp that has none. The
    /// error by number is in docs/accuracy.md.
    int samples = 16;
    std::vector<std::size_t> without = {};  ///< meshes that do not count, by index: the skin's own
    int threads = 0;                        ///< 0: one for each processor. The result does not depend on it.
};

struct VisibleShare {
    /// Share of each lamp's light that arrives at each place, [0, 1]: place i, lamp k at [i * lights + k]. 1
    /// where the lamp brings nothing anyway (below the horizon, outside the cone, off).
    std::vector<double> at_points;
    /// For each lamp the mean over the places, each counted by what the lamp would bring there: the factor on
    /// its part of the weight of a whole object. 1 where it brings nothing to any place.
    std::vector<double> mean;
};

/// How much of each lamp is seen from places that face along normals (of skin: its far side), with other
/// meshes in the way. What a lamp would bring is its irradiance; the share of it that arrives is found by
/// rays to points that cover the lamp, each counted by what it would bring. The points are those of a
/// low-discrepancy sequence, shifted from place to place, so that no number is random and the mean over many
/// places is far better than any one.
/// @param points, normals  as surface_irradiance
/// Throws std::invalid_argument on bad input, naming the entry.
VisibleShare visible_share(const Occluders& occluders, std::span<const Light> lights,
                           std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                           const VisibilityOptions& options = {});

}  // namespace skinglow
