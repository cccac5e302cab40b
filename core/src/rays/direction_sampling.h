#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Unit directions in a cone about +z, whose density falls linearly in cos(angle) from the axis to 0 at the
/// rim: the axis itself first, then Vogel's spiral (H. Vogel, "A better way to construct the sunflower head",
/// Math. Biosciences 44, 1979) lifted to the sphere. The same set each time: no random numbers, so that a
/// result is reproducible.
/// @param count       how many, 1 or more
/// @param half_angle  angle between axis and rim, radians, 0 to below pi/2
std::vector<glm::dvec3> cone_directions(int count, double half_angle);

/// Cosine-distributed unit directions about +z (Lambert), on the same spiral.
/// @param count  how many, 1 or more
std::vector<glm::dvec3> cosine_directions(int count);

struct WeightedValue {
    double value;
    double weight;  ///< above 0
};

/// Mean of the middle half: a quarter of the weight is cut off at either end, values at the cuts count in
/// part. As robust as need be (a quarter of the rays may be wrong) and, unlike a median, without steps
/// between neighbors.
/// @param samples  at least one; are sorted
double interquartile_mean(std::span<WeightedValue> samples);

}  // namespace skinglow::detail
