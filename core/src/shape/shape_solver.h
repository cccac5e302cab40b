#pragma once

#include <skinglow/shape.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "shape/lazy_part.h"
#include "shape/reentry.h"

namespace skinglow::detail {

struct SolverOptions {
    double unit_mm = 1;
    double cell_mm = 0.8;
    double max_thickness_mm = 25;
    int threads = 0;
};

/// Exitance of sites, node by node.
struct SiteLight {
    std::vector<Lanes> exitance;
    std::vector<Lanes> reflected;  ///< what a half-space would send out under the irradiance of the site
    /// What both are the sum of: light that entered skin once, twice, ..., and passed what covers the medium as often;
    /// none where it entered once.
    std::vector<SiteLight> passes = {};
};

/// The flesh of a mesh of one medium: from irradiance at its vertices to exitance at its sites, node by node.
/// May be asked from many threads at once.
class ShapeSolver {
  public:
    /// @param where  points whose exitance is asked
    ShapeSolver(const MeshView& mesh, const ShapePoints& where, const LaneMedium& medium,
                const SolverOptions& options);
    ShapeSolver(const ShapeSolver&) = delete;
    ShapeSolver& operator=(const ShapeSolver&) = delete;

    /// Exitance of all sites. Where the flesh is thick it is that of a half-space under the same irradiance.
    /// @param light       one per vertex of the mesh given
    /// @param reentries   how often light that leaves skin enters skin again
    /// @param on_the_way  what is left of it then, by what covers the medium
    SiteLight solve(std::span<const Lanes> light, double tolerance, int reentries = 0,
                    const Lanes& on_the_way = Lanes::all(1)) const;

    /// Vertices whose irradiance matters to the sites, not 0.
    /// @param reentries  how often light that leaves skin enters skin again before it gets there
    std::vector<std::uint8_t> wanted_vertices(int reentries) const;

    const Body& body() const { return body_; }
    const FleshSurface& surface() const { return surface_; }
    const SurfaceSites& sites() const { return sites_; }
    const SurfaceSites& vertex_sites() const;
    const std::vector<std::unique_ptr<LazyPart>>& parts() const { return parts_; }
    const LaneMedium& medium() const { return medium_; }
    std::size_t bytes() const;
    /// Of a job: what solve() takes, where rows of a site are 1. It expects by itself what it makes ready.
    double solve_work(int reentries) const;

  private:
    const PartSolver& solver_of(const LazyPart& part) const;
    const VertexRows& vertex_rows(const LazyPart& part, int step) const;
    /// Where light that enters skin again falls: in step 0 what matters to the sites themselves, in each further one
    /// what matters to the skin that the one before gets its light from, and is in none before.
    const Reentry& reentry(int step) const;
    /// Steps for light that has to enter skin as often: all vertices are in the first where they are the sites.
    int steps(int reentries) const { return sites_.are_vertices() ? std::min(reentries, 1) : reentries; }
    void mark_site_vertices(std::span<std::uint8_t> wanted) const;
    void mark_seen_in(int step, std::span<std::uint8_t> wanted) const;
    Lanes light_at(const SurfaceSites& of, const Site& site, std::span<const Lanes> light) const;
    std::vector<Lanes> half_space(const SurfaceSites& of, std::span<const Lanes> light) const;
    void solve_part(const LazyPart& part, bool is_lit, std::span<const Lanes> light, double tolerance,
                    std::span<Lanes> of_sites, std::span<Lanes> of_vertex_sites, int steps) const;

    SolverOptions options_;
    Body body_;
    FleshSurface surface_;
    SurfaceSites sites_;
    LaneMedium medium_;
    double margin_;
    std::vector<std::unique_ptr<LazyPart>> parts_;
    std::vector<std::uint8_t> is_solved_;  ///< one per site: no half-space is in it
    Lazy<SurfaceSites> vertex_sites_;      ///< where the sites are points
    std::array<Lazy<Reentry>, max_reentries> reentry_;
};

}  // namespace skinglow::detail
