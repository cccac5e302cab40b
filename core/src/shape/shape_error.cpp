#include "shape/shape_error.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

constexpr double least = 0.01;
constexpr double per_fall = 0.018;
constexpr double per_fall_of_cell = 0.030;
constexpr double cell_power = 1.3;
/// Smooth surfaces are further off: SP3 has their reflectance as moments alone.
constexpr double of_smooth = 1.15;
/// Of a tissue, between the nodes.
constexpr double of_spectrum = 0.04;
/// Flesh that light comes through, mm, and RMS over mean of such light on an ear.
constexpr double ear_mm = 3;
constexpr double ear_contrast = 1.7;
constexpr double channels = 3;

/// Per unit of log(brightest / exitance).
double error_per_fall(const Sp3Medium& medium, double cell) {
    const double surface = medium.refractive_index > 1 ? of_smooth : 1;
    return surface * (per_fall + per_fall_of_cell * std::pow(medium.decay[0] * cell, cell_power));
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

Lanes relative_error(const LaneMedium& medium, double cell, const Lanes& exitance, const Lanes& brightest) {
    return each_lane([&](std::size_t k) {
        if (!(exitance[k] > 0)) return 0.0F;
        const double fall =
            std::log(std::max(1.0, static_cast<double>(brightest[k]) / static_cast<double>(exitance[k])));
        return static_cast<float>(least + error_per_fall(medium[k], cell) * fall);
    });
}

double back_lit_error(const LaneMedium& medium, double cell) {
    double squares = 0;
    double sum = 0;
    for (std::size_t k = 0; k < medium.nodes(); ++k) {
        const double through = 0.5 * std::exp(-medium[k].decay[0] * ear_mm);
        const double error = through * (least - error_per_fall(medium[k], cell) * std::log(through));
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

void add_colored(std::span<const SiteLight> solved, std::vector<ColoredLight>& lights) {
    for (std::size_t i = 0; i < solved.size(); ++i) {
        glm::dvec3 color(solved.size() == 1 ? 1.0 : 0.0);
        if (solved.size() > 1) color[static_cast<int>(i)] = 1.0;
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
                const Lanes error =
                    relative_error(shape.solver->medium(), around[s].cell, exitance, around[s].brightest);
                // All nodes off the same way: what channels have of each other's is off with them.
                const glm::dvec3 found = shape.combine(exitance, reflected).exitance * one.color;
                const glm::dvec3 off =
                    shape.combine(exitance + exitance * error, reflected).exitance * one.color;
                const glm::dvec3 of_nodes = off - found;
                const glm::dvec3 between = shape.spectrum ? of_spectrum * found : glm::dvec3(0.0);
                for (int c = 0; c < 3; ++c) result[s][c] += std::hypot(of_nodes[c], between[c]);
            }
        }
    };
    for_each_block(result.size(), shape.options.threads, work, {}, 512);
    return result;
}

}  // namespace skinglow::detail
