#pragma once

#include <skinglow/light.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

constexpr std::size_t not_matched = std::numeric_limits<std::size_t>::max();

/// For each light the one of others that shines the same way, but for color and power; none for two. Among equal
/// ones that of the same index.
std::vector<std::size_t> matching_lights(std::span<const Light> lights, std::span<const Light> others);

}  // namespace skinglow::detail
