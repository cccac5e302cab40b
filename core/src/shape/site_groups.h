#pragma once

#include <span>

#include "shape/surface_sites.h"

namespace skinglow::detail {

/// Groups of sites to be solved apart, each with the flesh about it up to a margin. A group is what hangs
/// together by gaps below about a margin; where that is long beside the margin it is cut in two, and again,
/// where the least flesh lies in both.
/// @param chosen  indices of the sites to be grouped, ascending
std::vector<std::vector<std::uint32_t>> site_groups(const Body& body, const SurfaceSites& sites,
                                                    std::span<const std::uint32_t> chosen, double margin);

}  // namespace skinglow::detail
