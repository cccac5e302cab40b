#include "shape/shape_solver.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// Flesh about a thin site counts up to this many lengths over which the least absorbed light falls to 1/e.
constexpr double margin_in_decays = 2;
constexpr double margin_in_cells = 4;

double margin_of(const LaneMedium& medium, const SolverOptions& options) {
    const double decay = medium.min_decay();
    const double wanted = decay * options.max_thickness_mm > margin_in_decays ? margin_in_decays / decay
                                                                              : options.max_thickness_mm;
    return std::max(wanted, margin_in_cells * options.cell_mm);
}

SurfaceSites make_sites(const Body& body, const TriangleTree& tree, std::span<const glm::dvec3> points,
                        std::span<const glm::dvec3> normals) {
    if (points.empty()) return SurfaceSites(body);
    std::vector<glm::vec3> local;
    local.reserve(points.size());
    for (const glm::dvec3& p : points) local.push_back(body.local(p));
    const std::vector<glm::vec3> facing(normals.begin(), normals.end());
    return {body, tree, local, facing};
}

}  // namespace

ShapeSolver::ShapeSolver(const MeshView& mesh, std::span<const glm::dvec3> points,
                         std::span<const glm::dvec3> normals, const LaneMedium& medium,
                         const SolverOptions& options, const std::function<void(double)>& done)
    : options_(options),
      body_(mesh, options.unit_mm),
      surface_(body_, options.cell_mm),
      sites_(make_sites(body_, surface_.tree(), points, normals)),
      medium_(medium),
      margin_(margin_of(medium, options)) {
    const auto count = static_cast<double>(std::max<std::size_t>(1, sites_.sites().size()));
    thickness_ = site_thickness(surface_, sites_, options.threads, [&](std::size_t sites) {
        if (done) done(static_cast<double>(sites) / count);
    });
    for (ThinPart& part : thin_parts(body_, sites_, thickness_, options.max_thickness_mm, margin_))
        parts_.push_back(std::make_unique<LazyPart>(std::move(part)));
}

const PartSolver& ShapeSolver::solver_of(const LazyPart& part) const {
    return part.solver([&](const ThinPart& p) {
        const PartOptions options{options_.cell_mm, margin_, options_.threads, {.threads = options_.threads}};
        return std::make_unique<const PartSolver>(surface_, sites_, p.sites, medium_, options);
    });
}

Lanes ShapeSolver::light_at(const Site& site, std::span<const Lanes> light) const {
    if (!site.on_surface) return {};
    const auto at = [&](std::uint32_t triangle, float u, float v) {
        const glm::uvec3& c = body_.triangles()[triangle].corners;
        return light[c.x] * (1 - u - v) + light[c.y] * u + light[c.z] * v;
    };
    if (site.pieces == 0) return at(site.point.triangle, site.point.u, site.point.v);
    Lanes sum;
    float area = 0;
    for (const SitePiece& piece : sites_.pieces(site)) {
        const BodyTriangle& t = body_.triangles()[piece.triangle];
        // The mean by the hat function of what is linear: half of the corner, a quarter of the others.
        const Lanes all = light[t.corners.x] + light[t.corners.y] + light[t.corners.z];
        sum += (all + light[t.corners[piece.corner]]) * (0.25F * t.area);
        area += t.area;
    }
    return sum * (1 / area);
}

std::vector<Lanes> ShapeSolver::exitance(std::span<const Lanes> light, double tolerance) const {
    std::vector<Lanes> result(sites_.sites().size());
    const Lanes reflectance = medium_.lanes([](const Sp3Medium& m) { return m.half_space; });
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = light_at(sites_.sites()[i], light) * reflectance;
    const auto is_lit = [&](const ThinPart& part) {
        return std::any_of(part.vertices.begin(), part.vertices.end(), [&](std::uint32_t v) {
            return std::any_of(std::begin(light[v].v), std::end(light[v].v), [](float e) { return e != 0; });
        });
    };
    for (const auto& lazy : parts_) {
        const ThinPart& part = lazy->part();
        std::vector<Lanes> out(part.sites.size());
        if (is_lit(part)) {
            const PartSolver& solver = solver_of(*lazy);
            solver.exitance(solver.solve(light, tolerance), light, out, options_.threads);
        }
        for (std::size_t i = 0; i < out.size(); ++i) result[part.sites[i]] = out[i];
    }
    return result;
}

std::size_t ShapeSolver::bytes() const {
    std::size_t sum = 0;
    for (const auto& part : parts_) {
        if (const PartSolver* solver = part->ready()) sum += solver->bytes();
    }
    return sum;
}

}  // namespace skinglow::detail
