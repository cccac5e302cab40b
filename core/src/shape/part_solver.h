#pragma once

#include <span>
#include <vector>

#include "shape/last_flight.h"
#include "shape/sp3_system.h"

namespace skinglow::detail {

struct PartOptions {
    double cell = 0.8;  ///< mm
    double margin = 7;  ///< of flesh about the sites, mm
    int threads = 0;
    bool keep_grid = false;  ///< so that rows for more sites can be made
    LastFlightOptions flight = {};
};

/// What a part's equations say of a light.
struct PartField {
    std::vector<LanePair> modes;  ///< one per cell, and one of zeros
    std::vector<Lanes> fluence;   ///< at cells and ghosts
    int iterations = 0;
};

/// A part of the flesh, made ready: from the irradiance at the vertices to the exitance of its sites. May be
/// asked from many threads at once.
class PartSolver {
  public:
    /// @param sites  indices into `all`, ascending; at least one
    PartSolver(const FleshSurface& surface, const SurfaceSites& all, std::span<const std::uint32_t> sites,
               const LaneMedium& medium, const PartOptions& options);

    /// @param light  irradiance at each vertex of the mesh given, for each node
    PartField solve(std::span<const Lanes> light, double tolerance) const;

    /// Exitance of the sites, in their order; 0 or more.
    void exitance(const PartField& field, std::span<const Lanes> light, std::span<Lanes> out,
                  int threads) const {
        exitance(flight_, field, light, out, threads);
    }
    /// The same of other sites.
    static void exitance(const LastFlight& flight, const PartField& field, std::span<const Lanes> light,
                         std::span<Lanes> out, int threads);

    /// Rows for other sites; with `keep_grid` alone.
    LastFlight flight_of(const FleshSurface& surface, const SurfaceSites& all,
                         std::span<const std::uint32_t> sites, const LaneMedium& medium,
                         const LastFlightOptions& options) const {
        return last_flight(surface, grid_, ghosts_, medium, all, sites, options);
    }
    /// Whether a site lies on a cell.
    bool covers(const Site& site) const;

    /// Vertices whose irradiance is asked for.
    const std::vector<std::uint32_t>& lit_by() const { return lit_by_; }

    std::uint32_t cells() const { return grid_.size(); }
    double cell() const { return static_cast<double>(grid_.cell()); }
    /// Area of the surface that no cell was found for, over that of all that belongs to the part.
    double lost_fraction() const { return lost_fraction_; }
    std::size_t bytes() const;

  private:
    PartSolver(const FleshSurface& surface, const SurfaceSites& all, std::span<const std::uint32_t> sites,
               const LaneMedium& medium, const PartOptions& options, const VoxelGrid& grid);
    PartSolver(const FleshSurface& surface, const SurfaceSites& all, std::span<const std::uint32_t> sites,
               const LaneMedium& medium, const PartOptions& options, VoxelGrid grid,
               const BoundarySamples& samples);

    VoxelGrid grid_;
    Sp3System system_;
    SparseRows<LanePair> right_;
    Ghosts ghosts_;
    LastFlight flight_;
    std::vector<std::uint32_t> lit_by_;
    Lanes fluence1_, fluence2_;
    double lost_fraction_;
};

}  // namespace skinglow::detail
