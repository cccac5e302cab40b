#pragma once

#include <functional>
#include <limits>

#include "shape/flesh_surface.h"
#include "shape/surface_sites.h"

namespace skinglow::detail {

/// Sites that are solved together, and whose light matters to them.
struct ThinPart {
    std::vector<std::uint32_t> sites;     ///< ascending
    std::vector<float> weight;            ///< of each site, (0, 1]: of the solution; the rest is a half-space
    std::vector<std::uint32_t> vertices;  ///< of the mesh given, about them; ascending
    /// Those of them that are nearer to this part than to others, where the sites are no vertices.
    std::vector<std::uint32_t> own_vertices;
    double thin_mm = 0;  ///< thickness that a twentieth of the sites are below
};

/// Told how many sites are done.
using SitesDone = std::function<void(std::size_t)>;

/// Thickness of the flesh at a site, mm, that a third of some rays are shorter than. Infinite where they find
/// no end.
struct SiteThickness {
    float along_normal = std::numeric_limits<float>::infinity();  ///< by a narrow cone of rays
    /// By rays that follow the cosine, as light does: the foot of a lobe is thick along its normal and still as
    /// thin as the lobe.
    float to_light = std::numeric_limits<float>::infinity();
};

/// @param max_thickness  mm, what is thicker counts as infinite
std::vector<SiteThickness> site_thickness(const FleshSurface& surface, const SurfaceSites& sites,
                                          double max_thickness, int threads, const SitesDone& done);

/// Groups the sites that are thinner than a limit, and those about them, whose weight falls with the
/// distance. What lies behind the margin does not matter, so that any groups can be solved apart: they are
/// what hangs together by gaps below the margin, cut where it is narrow until no group is long beside the
/// margin.
/// @param light_distance  from a site to the farthest light that matters to it, mm
std::vector<ThinPart> thin_parts(const Body& body, const SurfaceSites& sites,
                                 const std::vector<SiteThickness>& thickness, double max_thickness,
                                 double margin, double light_distance);

}  // namespace skinglow::detail
