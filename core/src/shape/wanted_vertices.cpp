#include <algorithm>

#include "numerics/job.h"
#include "shape/shape_solver.h"

/// Which vertices matter: whose irradiance the sites depend on, and what light enters skin there again.
namespace skinglow::detail {
namespace {

/// Of a vertex whose exitance is only wanted as light for others: rays, and below what entries chance decides.
constexpr int reentry_rays = 32;
constexpr float small_reentry = 2e-3F;

}  // namespace

const VertexRows& ShapeSolver::vertex_rows(const LazyPart& part, int step) const {
    return part.vertices[static_cast<std::size_t>(step)].get([&] {
        const PartSolver& solver = solver_of(part);
        const auto is_seen_before = [&](std::uint32_t v) {
            for (int k = 0; k < step; ++k) {
                if (reentry(k).seen()[v] != 0) return true;
            }
            return false;
        };
        VertexRows rows;
        for (const std::uint32_t v : part.part.own_vertices) {
            if (reentry(step).seen()[v] == 0 || is_seen_before(v)) continue;
            const std::uint32_t s = vertex_sites().site_of()[v];
            if (solver.covers(vertex_sites().sites()[s])) rows.sites.push_back(s);
        }
        std::sort(rows.sites.begin(), rows.sites.end());
        rows.sites.erase(std::unique(rows.sites.begin(), rows.sites.end()), rows.sites.end());
        expect_work(static_cast<double>(rows.sites.size()));
        rows.flight = solver.flight_of(
            surface_, vertex_sites(), rows.sites, medium_,
            {.rays = reentry_rays, .small_entry = small_reentry, .threads = options_.threads});
        rows.lit_by = rows.flight.of_light.used_columns();
        return rows;
    });
}

const Reentry& ShapeSolver::reentry(int step) const {
    return reentry_[static_cast<std::size_t>(step)].get([&] {
        std::vector<std::uint8_t> wanted = wanted_vertices(step);
        for (int k = 0; k < step; ++k) {
            for (std::size_t v = 0; v < wanted.size(); ++v) {
                if (reentry(k).receives(v)) wanted[v] = 0;
            }
        }
        return Reentry(surface_, vertex_sites(), wanted, options_.threads);
    });
}

/// What matters to a part is a part of its vertices, and known once it is ready.
void ShapeSolver::mark_site_vertices(std::span<std::uint8_t> wanted) const {
    for (const auto& part : parts_) {
        const PartSolver* const solver = part->solver.ready();
        for (const std::uint32_t v : solver != nullptr ? solver->lit_by() : part->part.vertices)
            wanted[v] = 1;
    }
    for (std::size_t s = 0; s < is_solved_.size(); ++s) {
        const Site& site = sites_.sites()[s];
        if (is_solved_[s] != 0 || !site.on_surface) continue;
        for (int k = 0; k < 3; ++k) wanted[body_.triangles()[site.point.triangle].corners[k]] = 1;
    }
}

/// What a vertex sends out is a mean over its triangles, of the light at all of their corners.
void ShapeSolver::mark_seen_in(int step, std::span<std::uint8_t> wanted) const {
    const SurfaceSites& of_vertices = vertex_sites();
    const std::vector<std::uint8_t>& seen = reentry(step).seen();
    for (std::size_t v = 0; v < seen.size(); ++v) {
        if (seen[v] == 0) continue;
        for (const SitePiece& piece : of_vertices.pieces(of_vertices.sites()[of_vertices.site_of()[v]])) {
            for (int k = 0; k < 3; ++k) wanted[body_.triangles()[piece.triangle].corners[k]] = 1;
        }
    }
    for (const auto& part : parts_) {
        if (const VertexRows* rows = part->vertices[static_cast<std::size_t>(step)].ready()) {
            for (const std::uint32_t v : rows->lit_by) wanted[v] = 1;
        } else if (std::any_of(part->part.own_vertices.begin(), part->part.own_vertices.end(),
                               [&](std::uint32_t v) { return seen[v] != 0; })) {
            for (const std::uint32_t v : part->part.vertices) wanted[v] = 1;
        }
    }
}

std::vector<std::uint8_t> ShapeSolver::wanted_vertices(int reentries) const {
    std::vector<std::uint8_t> wanted(body_.welded_of().size(), sites_.are_vertices() ? 1 : 0);
    if (sites_.are_vertices()) return wanted;
    mark_site_vertices(wanted);
    for (int step = 0; step < reentries; ++step) mark_seen_in(step, wanted);
    return wanted;
}

}  // namespace skinglow::detail
