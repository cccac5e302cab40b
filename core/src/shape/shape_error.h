#pragma once

#include "shape/shape_data.h"

namespace skinglow::detail {

/// How far off a solved exitance is taken to be: one standard deviation over it, by node.
///
/// a + (b + c (decay cell)^p) log(brightest / exitance): most of the error is one of the rate at which light
/// falls in flesh, due to SP3 and to the grid, so that it grows with the powers of e that light has fallen by. The
/// numbers are fitted to the errors measured in docs/shape.md: above them, and less than three times of them.
/// @param brightest  irradiance of the part that the point is in
Lanes relative_error(const LaneMedium& medium, double cell, const Lanes& exitance, const Lanes& brightest);

/// The same of thin flesh that is lit from behind, as ears are: RMS over mean, all nodes together.
double back_lit_error(const LaneMedium& medium, double cell);

/// The largest cell whose back_lit_error is within a tolerance, mm, from min_cell to max_cell.
/// @throws std::invalid_argument naming the least tolerance that the smallest cells keep
double cell_for(const LaneMedium& medium, double tolerance, double min_cell, double max_cell);

/// Of ShapeData::solve's, each with its color.
void add_colored(std::span<const SiteLight> solved, std::vector<ColoredLight>& lights);

/// Estimated errors of the sum of some lights, W/m^2, one per site. Of a tissue, what becomes of color between the
/// nodes is part of it.
/// @param irradiance  all light at the vertices
std::vector<glm::dvec3> estimated_error(const ShapeData& shape, std::span<const ColoredLight> lights,
                                        std::span<const glm::dvec3> irradiance);

}  // namespace skinglow::detail
