#include "shape/shape_error.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

constexpr double least = 0.01;
constexpr double least_of_cell = 0.025;
constexpr double per_fall = 0.013;
constexpr double per_fall_of_cell = 0.030;
constexpr double cell_power = 1.3;
/// Light that falls by more than a power of e in a cell is off by less than by the power of the cell.
constexpr double cell_saturation = 0.25;
/// Smooth surfaces are further off: where they are round they focus, which SP3 knows about in part.
constexpr double of_smooth = 1.5;
/// Of a tissue, between the nodes.
constexpr double of_spectrum = 0.04;
/// Skin is lit through where more than this part of its light came from elsewhere.
constexpr double lit_through = 0.5;
/// Flesh that light comes through, mm, and RMS over mean of such light on an ear.
constexpr double ear_mm = 3;
constexpr double ear_contrast = 1.7;
constexpr double channels = 3;

double surface_factor(const Sp3Medium& medium) {
    return medium.refractive_index > 1 ? of_smooth : 1;
}

/// Of all light.
double least_error(const Sp3Medium& medium, double cell) {
    return surface_factor(medium) * (least + least_of_cell * medium.decay[0] * cell);
}

/// Of light that came from elsewhere, per unit of log(brightest / exitance).
double error_per_fall(const Sp3Medium& medium, double cell) {
    const double coarse = std::pow(medium.decay[0] * cell, cell_power);
    return surface_factor(medium) * (per_fall + per_fall_of_cell * coarse / (1 + cell_saturation * coarse));
}

Lanes max_of(const Lanes& a, const Lanes& b) {
    return each_lane([&](std::size_t k) { return std::max(a[k], b[k]); });
}

/// Irradiance as the nodes have it: by channel, or of a tissue the brightest channel's at all nodes.
Lanes at_nodes(const ShapeData& shape, const glm::dvec3& e) {
    if (shape.spectrum) return Lanes::all(static_cast<float>(std::max({e.r, e.g, e.b})));
    return {{static_cast<float>(e.r), static_cast<float>(e.g), static_cast<float>(e.b), 0}};
}

/// What a site's error depends on beside its own light.
struct Surroundings {
    Lanes brightest;
    double cell = 0;
};

std::vector<Surroundings> surroundings(const ShapeData& shape, std::span<const glm::dvec3> irradiance) {
    Lanes all;
    for (const glm::dvec3& e : irradiance) all = max_of(all, at_nodes(shape, e));
    std::vector<Surroundings> result(shape.solver->sites().sites().size(), {all, shape.options.cell_mm});
    for (const auto& lazy : shape.solver->parts()) {
        Lanes brightest;
        for (const std::uint32_t v : lazy->part.vertices)
            brightest = max_of(brightest, at_nodes(shape, irradiance[v]));
        const PartSolver* solver = lazy->solver.ready();
        const double cell = solver != nullptr ? solver->cell() : shape.options.cell_mm;
        for (const std::uint32_t s : lazy->part.sites) result[s] = {brightest, cell};
    }
    return result;
}

}  // namespace

Lanes error_of(const LaneMedium& medium, double cell, const Lanes& exitance, const Lanes& reflected,
               const Lanes& brightest) {
    return each_lane([&](std::size_t k) {
        if (!(exitance[k] > 0)) return 0.0F;
        const auto all = static_cast<double>(exitance[k]);
        const double through = std::abs(all - static_cast<double>(reflected[k]));
        const double fall = std::log(std::max(1.0, static_cast<double>(brightest[k]) / through));
        const double off = through > 0 ? error_per_fall(medium[k], cell) * fall * through : 0.0;
        // It cannot be off by more than that there is none.
        return static_cast<float>(std::min(all, least_error(medium[k], cell) * all + off));
    });
}

double back_lit_error(const LaneMedium& medium, double cell) {
    double squares = 0;
    double sum = 0;
    for (std::size_t k = 0; k < medium.nodes(); ++k) {
        const double through = 0.5 * std::exp(-medium[k].decay[0] * ear_mm);
        const double error =
            through * (least_error(medium[k], cell) - error_per_fall(medium[k], cell) * std::log(through));
        squares += error * error;
        sum += through;
    }
    return ear_contrast * std::sqrt(channels * squares) / sum;
}

double cell_for(const LaneMedium& medium, double tolerance, double min_cell, double max_cell) {
    require_positive("tolerance", tolerance);
    const double least_error = back_lit_error(medium, min_cell);
    if (tolerance < least_error) {
        refuse_argument("tolerance", to_text(tolerance),
                        to_text(std::ceil(100 * least_error) / 100) +
                            " or more in this medium, which cells of " + to_text(min_cell) + " mm keep");
    }
    double low = min_cell;
    double high = max_cell;
    if (back_lit_error(medium, high) <= tolerance) return high;
    for (int i = 0; i < 40; ++i) {
        const double center = 0.5 * (low + high);
        (back_lit_error(medium, center) <= tolerance ? low : high) = center;
    }
    return low;
}

void add_colored(std::span<const SiteLight> solved, std::vector<ColoredLight>& lights, double sign) {
    for (std::size_t i = 0; i < solved.size(); ++i) {
        glm::dvec3 color(solved.size() == 1 ? sign : 0.0);
        if (solved.size() > 1) color[static_cast<int>(i)] = sign;
        lights.push_back({&solved[i], color});
    }
}

std::vector<glm::dvec3> estimated_error(const ShapeData& shape, std::span<const ColoredLight> lights,
                                        std::span<const glm::dvec3> irradiance) {
    const std::vector<Surroundings> around = surroundings(shape, irradiance);
    std::vector<glm::dvec3> result(around.size(), glm::dvec3(0.0));
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            for (const ColoredLight& one : lights) {
                if (one.light->exitance.empty()) continue;
                const Lanes& exitance = one.light->exitance[s];
                const Lanes& reflected = one.light->reflected[s];
                const Lanes error = error_of(shape.solver->medium(), around[s].cell, exitance, reflected,
                                             around[s].brightest);
                // All nodes off the same way: what channels have of each other's is off with them.
                const glm::dvec3 found = shape.combine(exitance, reflected).exitance * one.color;
                const glm::dvec3 off = shape.combine(exitance + error, reflected).exitance * one.color;
                const glm::dvec3 of_nodes = off - found;
                const glm::dvec3 between = shape.spectrum ? of_spectrum * found : glm::dvec3(0.0);
                for (int c = 0; c < 3; ++c) {
                    const double all = std::hypot(of_nodes[c], between[c]);
                    result[s][c] += std::min(all, std::abs(found[c]));
                }
            }
        }
    };
    for_each_block(result.size(), shape.options.threads, work, {}, 512);
    return result;
}

namespace {

/// What a mean is made of, by channel: of all light, and of light where most of it came through.
struct ErrorSums {
    glm::dvec3 squares[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    glm::dvec3 light[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};

    void add(double area, const glm::dvec3& error, const glm::dvec3& exitance,
             const glm::dvec3& transmitted) {
        for (int c = 0; c < 3; ++c) {
            if (!(exitance[c] > 0)) continue;
            const int kinds = transmitted[c] > lit_through * exitance[c] ? 2 : 1;
            for (int kind = 0; kind < kinds; ++kind) {
                squares[kind][c] += area * error[c] * (error[c] / exitance[c]);
                light[kind][c] += area * exitance[c];
            }
        }
    }
    void add(const ErrorSums& other) {
        for (int kind = 0; kind < 2; ++kind) {
            squares[kind] += other.squares[kind];
            light[kind] += other.light[kind];
        }
    }
    glm::dvec3 mean() const {
        glm::dvec3 result(0.0);
        for (int c = 0; c < 3; ++c) {
            const int kind = light[1][c] > 0 ? 1 : 0;
            if (light[kind][c] > 0) result[c] = std::sqrt(squares[kind][c] / light[kind][c]);
        }
        return result;
    }
};

}  // namespace

MeanError mean_error(const ShapeSolver& solver, std::span<const glm::dvec3> error,
                     std::span<const glm::dvec3> exitance, std::span<const glm::dvec3> transmitted) {
    const SurfaceSites& sites = solver.sites();
    const auto area_of = [&](const Site& site) {
        double area = site.pieces == 0 ? 1 : 0;  // points have no area of their own
        for (const SitePiece& piece : sites.pieces(site))
            area += static_cast<double>(solver.body().triangles()[piece.triangle].area);
        return area;
    };
    MeanError result;
    ErrorSums all;
    for (const auto& lazy : solver.parts()) {
        ErrorSums part;
        if (lazy->solver.ready() != nullptr) {
            for (const std::uint32_t s : lazy->part.sites)
                part.add(area_of(sites.sites()[s]), error[s], exitance[s], transmitted[s]);
        }
        all.add(part);
        result.of_parts.push_back(part.mean());
    }
    result.of_all = all.mean();
    return result;
}

}  // namespace skinglow::detail
