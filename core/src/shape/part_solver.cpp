#include "shape/part_solver.h"

#include <algorithm>
#include <utility>

#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// All points that the exitance of the sites is a mean over, no farther apart than half the margin.
std::vector<glm::vec3> points_of(const Body& body, const SurfaceSites& all,
                                 std::span<const std::uint32_t> sites, double margin) {
    std::vector<glm::vec3> points;
    points.reserve(sites.size());
    for (const std::uint32_t i : sites) {
        const auto spread = all.spread(body, all.sites()[i], static_cast<float>(0.5 * margin));
        points.insert(points.end(), spread.begin(), spread.end());
    }
    return points;
}

}  // namespace

PartSolver::PartSolver(const FleshSurface& surface, const SurfaceSites& all,
                       std::span<const std::uint32_t> sites, const LaneMedium& medium,
                       const PartOptions& options)
    : PartSolver(surface, all, sites, medium, options,
                 VoxelGrid(surface, points_of(surface.body(), all, sites, options.margin), options.margin,
                           options.cell, options.threads)) {}

PartSolver::PartSolver(const FleshSurface& surface, const SurfaceSites& all,
                       std::span<const std::uint32_t> sites, const LaneMedium& medium,
                       const PartOptions& options, const VoxelGrid& grid)
    : PartSolver(surface, all, sites, medium, options, grid, boundary_samples(surface, grid)) {}

PartSolver::PartSolver(const FleshSurface& surface, const SurfaceSites& all,
                       std::span<const std::uint32_t> sites, const LaneMedium& medium,
                       const PartOptions& options, VoxelGrid grid, const BoundarySamples& samples)
    : grid_(std::move(grid)),
      system_(grid_, samples.samples, medium, options.margin),
      right_(boundary_light(surface.body(), grid_, samples.samples, medium)),
      ghosts_(make_ghosts(surface.body(), grid_, samples.samples, medium)),
      flight_(last_flight(surface, grid_, ghosts_, medium, all, sites, options.flight)),
      fluence1_(medium.lanes([&](const Sp3Medium& m) { return seen_fluence(m, options.cell)[0]; })),
      fluence2_(medium.lanes([&](const Sp3Medium& m) { return seen_fluence(m, options.cell)[1]; })),
      lost_fraction_(samples.lost_area / std::max(samples.lost_area + samples.area, 1e-30)) {
    if (!options.keep_grid) ghosts_.index = {};
    for (const auto& columns :
         {right_.used_columns(), ghosts_.of_light.used_columns(), flight_.of_light.used_columns()})
        lit_by_.insert(lit_by_.end(), columns.begin(), columns.end());
    std::sort(lit_by_.begin(), lit_by_.end());
    lit_by_.erase(std::unique(lit_by_.begin(), lit_by_.end()), lit_by_.end());
    lit_by_.shrink_to_fit();
}

PartField PartSolver::solve(std::span<const Lanes> light, double tolerance) const {
    const std::uint32_t cells = system_.size();
    PartField field;
    std::vector<LanePair> right(cells);
    for (std::uint32_t c = 0; c < cells; ++c) {
        const auto vertices = right_.columns(c);
        const auto values = right_.values(c);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Lanes& e = light[vertices[i]];
            right[c].first += values[i].first * e;
            right[c].second += values[i].second * e;
        }
    }
    field.modes.resize(cells + 1);
    field.iterations = system_.solve(right, field.modes, tolerance);
    const auto& modes = field.modes;
    field.fluence.resize(cells + ghosts_.of_modes.rows());
    for (std::uint32_t c = 0; c < cells; ++c)
        field.fluence[c] = fluence1_ * modes[c].first + fluence2_ * modes[c].second;
    for (std::size_t g = 0; g < ghosts_.of_modes.rows(); ++g) {
        Lanes sum;
        const auto from = ghosts_.of_modes.columns(g);
        const auto factor = ghosts_.of_modes.values(g);
        for (std::size_t i = 0; i < from.size(); ++i)
            sum += factor[i].first * modes[from[i]].first + factor[i].second * modes[from[i]].second;
        const auto vertices = ghosts_.of_light.columns(g);
        const auto values = ghosts_.of_light.values(g);
        for (std::size_t i = 0; i < vertices.size(); ++i) sum += values[i] * light[vertices[i]];
        field.fluence[cells + g] = sum;
    }
    return field;
}

bool PartSolver::covers(const Site& site) const {
    return site.on_surface &&
           grid_.at(grid_.voxel_of(site.position - site.normal * (0.5F * grid_.cell()))) >= 0;
}

void PartSolver::exitance(const LastFlight& flight, const PartField& field, std::span<const Lanes> light,
                          std::span<Lanes> out, int threads) {
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            Lanes sum;
            const auto cells = flight.of_fluence.columns(s);
            const auto weights = flight.of_fluence.values(s);
            for (std::size_t i = 0; i < cells.size(); ++i)
                sum += unpack(weights[i]) * field.fluence[cells[i]];
            const auto vertices = flight.of_light.columns(s);
            const auto through = flight.of_light.values(s);
            for (std::size_t i = 0; i < vertices.size(); ++i) sum += unpack(through[i]) * light[vertices[i]];
            out[s] = each_lane([&](std::size_t k) { return std::max(0.0F, sum[k]); });
        }
    };
    for_each_block(out.size(), threads, work, {}, 1024);
}

std::size_t PartSolver::bytes() const {
    return grid_.bytes() + system_.bytes() + right_.bytes() + ghosts_.bytes() + flight_.bytes();
}

}  // namespace skinglow::detail
