#include "shape/shape_solver.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/job.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// Flesh about a thin site counts up to this many lengths over which the least absorbed light falls to 1/e.
constexpr double margin_in_decays = 2;
constexpr double margin_in_cells = 4;
/// Through flesh that is thicker than this many of these lengths nothing comes.
constexpr double thickness_in_decays = 5;
/// Cells through the thin regions of a part, at least; and where cells are longer than a mean free path. Not
/// below a part of the cell that is asked for.
constexpr double cells_through = 1.2;
constexpr double coarse_cells_through = 3;
constexpr double finest_of_wanted = 0.05;
/// Voxels of a grid's box, for memory's sake.
constexpr double max_voxels = 6e7;
constexpr double max_refined_voxels = 4e6;  // with cells smaller than asked for
/// Flesh in which light falls by this many powers of e within a cell is a half-space.
constexpr double opaque = 3;
/// What solving takes, by site, where making a site's rows is 1.
constexpr double work_of_solved = 0.02;

/// Points farther away are no points of the body.
constexpr double farthest_mm = 1e9;

double margin_of(const LaneMedium& medium, const SolverOptions& options) {
    const double decay = medium.min_decay();
    const double wanted = decay * options.max_thickness_mm > margin_in_decays ? margin_in_decays / decay
                                                                              : options.max_thickness_mm;
    return std::max(wanted, margin_in_cells * options.cell_mm);
}

/// From a site of a part to the farthest light that matters to it: at the surface of its cells, or at the end of a
/// flight.
double light_distance(const LaneMedium& medium, const SolverOptions& options, double margin) {
    return std::max(margin + margin_in_cells * options.cell_mm, max_flight_depth / medium.min_extinction());
}

/// The cell of a part: no larger than what most of it is thick, and no smaller than its box can hold.
double cell_of(const ThinPart& part, const Body& body, const SurfaceSites& sites, const LaneMedium& medium,
               double margin, double wanted) {
    std::vector<glm::vec3> centers;
    for (const std::uint32_t s : part.sites) {
        const auto spread = sites.spread(body, sites.sites()[s], static_cast<float>(margin));
        centers.insert(centers.end(), spread.begin(), spread.end());
    }
    const double through = std::min(part.thin_mm / cells_through, 1 / medium.min_extinction());
    const double thin = std::max(part.thin_mm / coarse_cells_through, through);
    double cell = std::min(wanted, std::max(thin, finest_of_wanted * wanted));
    while (box_voxels(centers, margin, cell) > (cell < wanted ? max_refined_voxels : max_voxels)) cell *= 1.1;
    return cell;
}

bool shines_on(const ThinPart& part, std::span<const Lanes> light) {
    return std::any_of(part.vertices.begin(), part.vertices.end(), [&](std::uint32_t v) {
        return std::any_of(std::begin(light[v].v), std::end(light[v].v), [](float e) { return e != 0; });
    });
}

SurfaceSites make_sites(const Body& body, const TriangleTree& tree, const ShapePoints& where, int threads) {
    if (!where.points) return SurfaceSites(body);
    const std::span<const glm::dvec3> points = *where.points;
    std::vector<glm::vec3> local;
    local.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        local.push_back(body.local(points[i]));
        if (!(max_abs(glm::dvec3(local.back())) <= farthest_mm))
            refuse_argument(entry_name("points", i)(), to_text(points[i]),
                            "up to 1e9 mm from the body's center");
    }
    // Before single precision, in which short and long normals are 0 and infinite.
    std::vector<glm::vec3> facing;
    facing.reserve(where.normals.size());
    for (const glm::dvec3& n : where.normals) facing.emplace_back(n == glm::dvec3(0.0) ? n : unit(n));
    return {body, tree, local, facing, threads};
}

}  // namespace

ShapeSolver::ShapeSolver(const MeshView& mesh, const ShapePoints& where, const LaneMedium& medium,
                         const SolverOptions& options)
    : options_(options),
      body_(mesh, options.unit_mm),
      surface_(body_, options.cell_mm),
      sites_(make_sites(body_, surface_.tree(), where, options.threads)),
      medium_(medium),
      margin_(margin_of(medium, options)) {
    expect_work(static_cast<double>(sites_.sites().size()));
    std::size_t done = 0;
    const double max_thickness = std::min(options.max_thickness_mm, thickness_in_decays / medium.min_decay());
    const auto thickness =
        site_thickness(surface_, sites_, max_thickness, options.threads, [&](std::size_t sites) {
            finish_work(static_cast<double>(sites - done));
            done = sites;
        });
    is_solved_.assign(sites_.sites().size(), 0);
    for (ThinPart& part : thin_parts(body_, sites_, thickness, max_thickness, margin_,
                                     light_distance(medium, options, margin_))) {
        for (std::size_t i = 0; i < part.sites.size(); ++i) is_solved_[part.sites[i]] = part.weight[i] == 1;
        parts_.push_back(std::make_unique<LazyPart>());
        parts_.back()->part = std::move(part);
    }
}

const SurfaceSites& ShapeSolver::vertex_sites() const {
    return sites_.are_vertices() ? sites_ : vertex_sites_.get([&] { return SurfaceSites(body_); });
}

const PartSolver& ShapeSolver::solver_of(const LazyPart& part) const {
    return part.solver.get([&] {
        const PartOptions options{cell_of(part.part, body_, sites_, medium_, margin_, options_.cell_mm),
                                  margin_,
                                  options_.threads,
                                  !sites_.are_vertices(),
                                  {.threads = options_.threads}};
        return PartSolver(surface_, sites_, part.part.sites, medium_, options);
    });
}

Lanes ShapeSolver::light_at(const SurfaceSites& of, const Site& site, std::span<const Lanes> light) const {
    if (!site.on_surface) return {};
    if (site.pieces == 0) {
        const glm::uvec3& c = body_.triangles()[site.point.triangle].corners;
        return light[c.x] * (1 - site.point.u - site.point.v) + light[c.y] * site.point.u +
               light[c.z] * site.point.v;
    }
    Lanes sum;
    float area = 0;
    for (const SitePiece& piece : of.pieces(site)) {
        const BodyTriangle& t = body_.triangles()[piece.triangle];
        // The mean by the hat function of what is linear: half of the corner, a quarter of the others.
        const Lanes all = light[t.corners.x] + light[t.corners.y] + light[t.corners.z];
        sum += (all + light[t.corners[piece.corner]]) * (0.25F * t.area);
        area += t.area;
    }
    return sum * (1 / area);
}

std::vector<Lanes> ShapeSolver::half_space(const SurfaceSites& of, std::span<const Lanes> light) const {
    const Lanes reflectance = medium_.lanes([](const Sp3Medium& m) { return m.half_space; });
    std::vector<Lanes> result(of.sites().size());
    for (std::size_t s = 0; s < result.size(); ++s)
        result[s] = light_at(of, of.sites()[s], light) * reflectance;
    return result;
}

void ShapeSolver::solve_part(const LazyPart& part, bool is_lit, std::span<const Lanes> light,
                             double tolerance, std::span<Lanes> of_sites, std::span<Lanes> of_vertex_sites,
                             int steps) const {
    const std::vector<std::uint32_t>& sites = part.part.sites;
    std::vector<Lanes> out(sites.size());
    if (is_lit) {
        const PartSolver& solver = solver_of(part);
        const PartField field = solver.solve(light, tolerance);
        solver.exitance(field, light, out, 1);
        for (int step = 0; step < steps && !of_vertex_sites.empty(); ++step) {
            const VertexRows& rows = vertex_rows(part, step);
            std::vector<Lanes> found(rows.sites.size());
            PartSolver::exitance(rows.flight, field, light, found, 1);
            for (std::size_t i = 0; i < found.size(); ++i) of_vertex_sites[rows.sites[i]] = found[i];
        }
    }
    const Lanes is_solved = medium_.lanes([&](const Sp3Medium& m) {
        const double cell = is_lit ? solver_of(part).cell() : 0.0;
        return m.decay[0] * cell > opaque ? 0.0 : 1.0;
    });
    for (std::size_t i = 0; i < out.size(); ++i) {
        Lanes& of_site = of_sites[sites[i]];
        const Lanes weight = is_solved * part.part.weight[i];
        of_site = of_site * (Lanes::all(1) - weight) + out[i] * weight;
    }
}

SiteLight ShapeSolver::solve(std::span<const Lanes> light, double tolerance, int reentries,
                             const Lanes& on_the_way) const {
    SiteLight result;
    std::vector<Lanes> entering(light.begin(), light.end());
    for (int pass = 0;; ++pass) {
        const std::vector<Lanes> reflected = half_space(sites_, entering);
        std::vector<Lanes> exitance = reflected;
        // What falls on skin again comes from vertices.
        const int left = steps(reentries - pass);
        const bool goes_on = left > 0;
        const bool has_points = !sites_.are_vertices();
        std::vector<Lanes> of_vertices;
        if (goes_on && has_points) of_vertices = half_space(vertex_sites(), entering);
        std::vector<std::uint8_t> is_lit;
        for (const auto& part : parts_) {
            is_lit.push_back(shines_on(part->part, entering) ? 1 : 0);
            if (is_lit.back() != 0 && part->solver.ready() == nullptr)
                expect_work(static_cast<double>(part->part.sites.size()));
        }
        const auto work = [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                solve_part(*parts_[p], is_lit[p] != 0, entering, tolerance, exitance, of_vertices, left);
                finish_work(work_of_solved * static_cast<double>(parts_[p]->part.sites.size()));
            }
        };
        for_each_block(parts_.size(), options_.threads, work, {}, 1);
        if (pass == 0) {
            result = {exitance, reflected};
        } else {
            for (std::size_t s = 0; s < exitance.size(); ++s) {
                result.exitance[s] += exitance[s];
                result.reflected[s] += reflected[s];
            }
        }
        if (reentries > 0) result.passes.push_back({exitance, reflected});
        if (!goes_on) return result;
        const std::vector<Lanes>& from = has_points ? of_vertices : exitance;
        std::vector<Lanes> leaving(entering.size());
        for (std::size_t v = 0; v < leaving.size(); ++v) leaving[v] = from[vertex_sites().site_of()[v]];
        std::fill(entering.begin(), entering.end(), Lanes{});
        for (int step = 0; step < left; ++step)
            reentry(step).add_irradiance(leaving, entering, options_.threads);
        for (Lanes& e : entering) e = e * on_the_way;
    }
}

double ShapeSolver::solve_work(int reentries) const {
    std::size_t sites = 0;
    for (const auto& part : parts_) sites += part->part.sites.size();
    return work_of_solved * static_cast<double>(sites) * (reentries + 1);
}

std::size_t ShapeSolver::bytes() const {
    std::size_t sum = 0;
    for (const auto& part : parts_) sum += part->bytes();
    for (const Lazy<Reentry>& step : reentry_) {
        if (const Reentry* rows = step.ready()) sum += rows->bytes();
    }
    return sum;
}

}  // namespace skinglow::detail
