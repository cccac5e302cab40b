#pragma once

#include <span>

#include "shape/boundary_light.h"
#include "shape/surface_sites.h"

namespace skinglow::detail {

/// The exitance of sites as a matrix, one row a site. Rays, cosine-distributed, go inward from the surface
/// about the site; along each the light that was scattered last there comes out, M = escape (albedo / 4
/// sum_steps (exp(-st s0) - exp(-st s1)) fluence + exp(-st length) light at its end) Small entries are left
/// to chance, and weigh more where they stay: nothing is lost in the mean.
struct LastFlight {
    SparseRows<PackedLanes> of_fluence;  ///< columns are cells and ghosts
    SparseRows<PackedLanes> of_light;    ///< columns are vertices: what comes through without a collision

    std::size_t bytes() const { return of_fluence.bytes() + of_light.bytes(); }
};

/// Rays end where all nodes have fallen to exp(-max_flight_depth).
constexpr double max_flight_depth = 7;

struct LastFlightOptions {
    int rays = 128;             ///< a site
    float small_entry = 5e-4F;  ///< of a row whose weights sum to about 1: below, chance decides
    int threads = 0;
};

/// @param ghosts  of the grid
/// @param sites   indices into `all`
LastFlight last_flight(const FleshSurface& surface, const VoxelGrid& grid, const Ghosts& ghosts,
                       const LaneMedium& medium, const SurfaceSites& all,
                       std::span<const std::uint32_t> sites, const LastFlightOptions& options);

}  // namespace skinglow::detail
