#pragma once

#include <span>
#include <vector>

#include "shape/flesh_surface.h"
#include "shape/lanes.h"
#include "shape/sparse_rows.h"
#include "shape/surface_sites.h"

namespace skinglow::detail {

/// Light that leaves skin and falls on skin: irradiance at vertices from the exitance at vertices, which
/// leaves as from a Lambertian surface. Rays, cosine-distributed, go outward; what they meet from outside
/// shines back.
class Reentry {
  public:
    /// @param sites   of the mesh's vertices
    /// @param wanted  vertices, one per vertex given, not 0: their irradiance matters
    Reentry(const FleshSurface& surface, const SurfaceSites& sites, std::span<const std::uint8_t> wanted,
            int threads);

    /// @param exitance  one per vertex
    std::vector<Lanes> irradiance(std::span<const Lanes> exitance, int threads) const;

    /// Vertices whose exitance is seen from somewhere: not 0.
    const std::vector<std::uint8_t>& seen() const { return seen_; }
    std::size_t bytes() const {
        return rows_.bytes() + row_of_.size() * sizeof(std::uint32_t) + seen_.size();
    }

  private:
    std::vector<std::uint32_t> row_of_;  ///< for each vertex; rows_.rows(): receives nothing
    SparseRows<float> rows_;             ///< columns are vertices
    std::vector<std::uint8_t> seen_;
};

}  // namespace skinglow::detail
