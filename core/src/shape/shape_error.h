#pragma once

#include "shape/shape_data.h"

namespace skinglow::detail {

/// How far off a solved exitance is taken to be: one standard deviation, by node.
///
/// Light that came from elsewhere, T = |exitance - reflected|, is off by the rate at which it falls in flesh, due to
/// SP3 and to the grid: by (b + c (decay cell)^p) T log(brightest / T), as it grows with the powers of e that light
/// has fallen by. And all light by a part that grows with the cells. The numbers are fitted to the errors measured in
/// docs/shape.md: above them, and less than three times of them.
/// @param reflected  what a half-space would send out under the irradiance of the point
/// @param brightest  irradiance of the part that the point is in
Lanes error_of(const LaneMedium& medium, double cell, const Lanes& exitance, const Lanes& reflected,
               const Lanes& brightest);

/// The same of thin flesh that is lit from behind, as ears are: RMS over mean, all nodes together.
double back_lit_error(const LaneMedium& medium, double cell);

/// The largest cell whose back_lit_error is within a tolerance, mm, from min_cell to max_cell.
/// @throws std::invalid_argument naming the least tolerance that the smallest cells keep
double cell_for(const LaneMedium& medium, double tolerance, double min_cell, double max_cell);

/// Of ShapeData::solve's, each with its color, times a sign.
void add_colored(std::span<const SiteLight> solved, std::vector<ColoredLight>& lights, double sign = 1);

/// Estimated errors of the sum of some lights, W/m^2, one per site. Of a tissue, what becomes of color between the
/// nodes is part of it.
/// @param irradiance  all light at the vertices
std::vector<glm::dvec3> estimated_error(const ShapeData& shape, std::span<const ColoredLight> lights,
                                        std::span<const glm::dvec3> irradiance);

/// Over skin that is lit through, most of whose light came from elsewhere, or all of it where there is none: the RMS of
/// error / exitance, each site weighted by the light that leaves it, its area times exitance. For all parts together,
/// and for each; 0 where nothing is solved. All arguments by site.
struct MeanError {
    glm::dvec3 of_all{0.0};
    std::vector<glm::dvec3> of_parts;
};
MeanError mean_error(const ShapeSolver& solver, std::span<const glm::dvec3> error,
                     std::span<const glm::dvec3> exitance, std::span<const glm::dvec3> transmitted);

}  // namespace skinglow::detail
