#pragma once

#include <functional>

#include "shape/flesh_surface.h"
#include "shape/surface_sites.h"

namespace skinglow::detail {

/// Sites that are solved together, and whose light matters to them.
struct ThinPart {
    std::vector<std::uint32_t> sites;     ///< ascending
    std::vector<std::uint32_t> vertices;  ///< of the mesh given, about them; ascending
    double thin_mm = 0;                   ///< thickness that a twentieth of the sites are below
};

/// Told how many sites are done.
using SitesDone = std::function<void(std::size_t)>;

/// Thickness of the flesh at sites along a narrow cone of rays, mm: a third of them are shorter. Infinite
/// where they find no end.
std::vector<float> site_thickness(const FleshSurface& surface, const SurfaceSites& sites, int threads,
                                  const SitesDone& done);

/// Groups the sites that are thinner than a limit; those of a group hang together by gaps below `margin`.
/// What lies behind the margin does not matter, so that groups can be solved apart.
std::vector<ThinPart> thin_parts(const Body& body, const SurfaceSites& sites,
                                 const std::vector<float>& thickness, double max_thickness, double margin);

}  // namespace skinglow::detail
