#include <skinglow/shape.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/argument_check.h"
#include "shape/shape_error.h"

namespace skinglow {
namespace {

constexpr int spectral_node_count = 4;
constexpr double min_cell_mm = 0.02;
constexpr double max_cell_mm = 1000;
/// Points at which flesh is looked for, at so many of the surface's gaps behind them.
constexpr std::size_t max_asked = 1000;
constexpr float asked_depth = 4;
/// Chosen from a tolerance. Smaller ones are only slower: what is left is SP3's.
constexpr double finest_chosen_mm = 0.3;
constexpr double coarsest_chosen_mm = 1.6;

void validate(const MeshView& mesh, const ShapeOptions& options, const ShapePoints& points) {
    if (mesh.triangles().empty()) refuse_argument("triangles", "empty", "at least one triangle");
    require_positive("unit_mm", options.unit_mm);
    if (!(options.cell_mm >= min_cell_mm && options.cell_mm <= max_cell_mm))
        refuse_argument("cell_mm", to_text(options.cell_mm), "0.02 to 1000");
    require_positive("max_thickness_mm", options.max_thickness_mm);
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
    const std::span<const glm::dvec3> given = points.points.value_or(std::span<const glm::dvec3>());
    if (!points.normals.empty() && points.normals.size() != given.size()) {
        refuse_argument("normals", std::to_string(points.normals.size()) + " of them",
                        "one for each of " + std::to_string(given.size()) + " points, or none");
    }
    for (std::size_t i = 0; i < given.size(); ++i) require_finite(entry_name("points", i), given[i]);
    for (std::size_t i = 0; i < points.normals.size(); ++i)
        require_finite(entry_name("normals", i), points.normals[i]);
}

void require_irradiance(std::span<const glm::dvec3> irradiance, std::size_t vertices) {
    if (irradiance.size() != vertices) {
        refuse_argument("irradiance", std::to_string(irradiance.size()) + " entries",
                        "one for each of " + std::to_string(vertices) + " vertices");
    }
    require_irradiances("irradiance", irradiance);
}

/// With the cell that a tolerance asks for.
ShapeOptions chosen(const ShapeOptions& given, const LaneMedium& medium) {
    ShapeOptions result = given;
    if (given.tolerance != 0)
        result.cell_mm = cell_for(medium, given.tolerance, finest_chosen_mm, coarsest_chosen_mm);
    return result;
}

double coefficient(const char* name, int channel, double value) {
    if (!(value >= 0 && value <= max_shape_coefficient))
        refuse_argument(std::string(name) + "[" + std::to_string(channel) + "]", to_text(value),
                        "0 to 1e5 per mm");
    return value;
}

ShapeSurface finish_of(SurfaceFinish finish) {
    return finish == SurfaceFinish::rough ? ShapeSurface::rough : ShapeSurface::smooth;
}

LaneMedium lanes_of(const ShapeMedium& medium, SurfaceFinish finish) {
    if (!(medium.refractive_index >= 1 && medium.refractive_index <= max_shape_refractive_index))
        refuse_argument("refractive_index", to_text(medium.refractive_index), "1 to 3");
    std::vector<Sp3Medium> media;
    for (int c = 0; c < 3; ++c) {
        const double absorption = coefficient("absorption", c, medium.absorption[c]);
        const double scattering = coefficient("reduced_scattering", c, medium.reduced_scattering[c]);
        if (!(absorption + scattering >= 1e-6)) {
            refuse_argument("absorption + reduced_scattering of channel " + std::to_string(c),
                            to_text(absorption + scattering), "1e-6 per mm or more: clear glass is no flesh");
        }
        media.push_back(sp3_medium(absorption, scattering, medium.refractive_index, finish_of(finish)));
    }
    return LaneMedium(media);
}

LaneMedium lanes_of(const SpectralNodes& spectrum, SurfaceFinish finish) {
    std::vector<Sp3Medium> media;
    for (const SpectralNodes::Node& node : spectrum.nodes) {
        media.push_back(sp3_medium(node.absorption, node.reduced_scattering, spectrum.refractive_index,
                                   finish_of(finish)));
    }
    return LaneMedium(media);
}

}  // namespace

namespace detail {

ShapeData::ShapeData(const MeshView& mesh, const LaneMedium& medium, std::optional<SpectralNodes> nodes,
                     const ShapeOptions& given, const ShapePoints& where)
    : options(given),
      vertices(mesh.vertices().begin(), mesh.vertices().end()),
      spectrum(std::move(nodes)),
      solver(std::make_shared<const ShapeSolver>(
          mesh, where, medium,
          SolverOptions{given.unit_mm, given.cell_mm, given.max_thickness_mm, given.threads})) {
    const Body& body = solver->body();
    if (!where.points) {
        points = vertices;
    } else {
        for (const Site& site : solver->sites().sites())
            points.push_back(body.origin() + glm::dvec3(site.position) / given.unit_mm);
    }
    set_thick();
}

void run_or_cancel(const ShapeProgress& progress, const std::function<void()>& work) {
    if (!run_job(progress, work)) throw ShapeCancelled();
}

}  // namespace detail

std::string_view to_text(SurfaceFinish finish) {
    return finish == SurfaceFinish::rough ? "rough" : "smooth";
}

SurfaceFinish surface_finish(std::string_view name) {
    if (name == "rough") return SurfaceFinish::rough;
    if (name == "smooth") return SurfaceFinish::smooth;
    refuse_argument("surface", "\"" + std::string(name) + "\"", R"("rough" or "smooth")");
}

Shape::Shape(const MeshView& mesh, const ShapeMedium& medium, const ShapeOptions& options,
             const ShapePoints& points, const ShapeProgress& progress) {
    validate(mesh, options, points);
    run_or_cancel(progress, [&] {
        const LaneMedium lanes = lanes_of(medium, options.surface);
        data_ = std::make_shared<const ShapeData>(mesh, lanes, std::nullopt, chosen(options, lanes), points);
    });
}

Shape::Shape(const MeshView& mesh, const Tissue& tissue, const ShapeOptions& options,
             const ShapePoints& points, const ShapeProgress& progress) {
    validate(mesh, options, points);
    run_or_cancel(progress, [&] {
        SpectralNodes spectrum = spectral_nodes(tissue, spectral_node_count);
        const LaneMedium medium = lanes_of(spectrum, options.surface);
        data_ = std::make_shared<const ShapeData>(mesh, medium, std::move(spectrum), chosen(options, medium),
                                                  points);
    });
}

Shape Shape::with_tissue(const Tissue& tissue) const {
    if (!data_->spectrum)
        refuse_argument("tissue", "given", "none: this shape is of coefficients, not of a tissue");
    Shape result = *this;
    result.data_ = std::make_shared<const ShapeData>(*data_, tissue);
    return result;
}

const std::vector<glm::dvec3>& Shape::points() const {
    return data_->points;
}

const ShapeOptions& Shape::options() const {
    return data_->options;
}

std::size_t Shape::vertices() const {
    return data_->vertices.size();
}

std::size_t Shape::bytes() const {
    return data_->solver->bytes();
}

double Shape::enclosed_fraction() const {
    const FleshSurface& surface = data_->solver->surface();
    const std::vector<Site>& sites = data_->solver->sites().sites();
    const std::size_t step = sites.size() / max_asked + 1;
    std::size_t asked = 0;
    std::size_t inside = 0;
    for (std::size_t s = 0; s < sites.size(); s += step, ++asked) {
        const glm::vec3 behind = sites[s].position - sites[s].normal * (asked_depth * surface.gap());
        inside += surface.is_inside(behind) ? 1 : 0;
    }
    return asked == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(asked);
}

std::vector<ShapePart> Shape::parts() const {
    std::vector<std::vector<std::uint32_t>> points_of(data_->solver->sites().sites().size());
    const auto& site_of = data_->solver->sites().site_of();
    for (std::uint32_t i = 0; i < site_of.size(); ++i) points_of[site_of[i]].push_back(i);
    std::vector<ShapePart> result;
    for (const auto& lazy : data_->solver->parts()) {
        ShapePart part{};
        for (const std::uint32_t s : lazy->part.sites)
            part.points.insert(part.points.end(), points_of[s].begin(), points_of[s].end());
        std::sort(part.points.begin(), part.points.end());
        for (const std::uint32_t i : part.points)
            part.center += data_->points[i] / static_cast<double>(part.points.size());
        if (const PartSolver* solver = lazy->solver.ready()) {
            part.is_ready = true;
            part.cell_mm = solver->cell();
            part.cells = solver->cells();
            part.bytes = lazy->bytes();
            part.lost_area_fraction = solver->lost_fraction();
        }
        result.push_back(std::move(part));
    }
    return result;
}

std::vector<glm::dvec3> Shape::exitance(std::span<const glm::dvec3> irradiance,
                                        const ShapeProgress& progress) const {
    require_irradiance(irradiance, vertices());
    std::vector<glm::dvec3> of_sites;
    run_or_cancel(progress, [&] { of_sites = data_->colors(data_->solve(irradiance, {})).exitance; });
    return data_->at_points(of_sites);
}

std::vector<glm::dvec3> Shape::exitance_error(std::span<const glm::dvec3> irradiance,
                                              const ShapeProgress& progress) const {
    require_irradiance(irradiance, vertices());
    std::vector<glm::dvec3> of_sites;
    run_or_cancel(progress, [&] {
        const std::vector<SiteLight> solved = data_->solve(irradiance, {});
        std::vector<ColoredLight> lights;
        add_colored(solved, lights);
        of_sites = estimated_error(*data_, lights, irradiance);
    });
    return data_->at_points(of_sites);
}

}  // namespace skinglow
