#pragma once

#include <cstdint>
#include <limits>
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

    /// Adds to the irradiance at the wanted vertices.
    /// @param exitance  one per vertex
    void add_irradiance(std::span<const Lanes> exitance, std::span<Lanes> irradiance, int threads) const;

    /// Whether a vertex is a wanted one, with a surface.
    bool receives(std::size_t vertex) const { return row_of_[vertex] != not_wanted; }

    /// Vertices whose exitance is seen from somewhere: not 0.
    const std::vector<std::uint8_t>& seen() const { return seen_; }
    std::size_t bytes() const {
        return rows_.bytes() + row_of_.size() * sizeof(std::uint32_t) + seen_.size();
    }

  private:
    static constexpr std::uint32_t not_wanted = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::uint32_t> row_of_;  ///< for each vertex
    SparseRows<float> rows_;             ///< columns are vertices
    std::vector<std::uint8_t> seen_;
};

}  // namespace skinglow::detail
