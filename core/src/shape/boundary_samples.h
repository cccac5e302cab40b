#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shape/voxel_grid.h"

namespace skinglow::detail {

/// A small piece of the surface, given to a cell.
struct BoundarySample {
    std::uint32_t cell;
    std::uint32_t triangle;
    float u, v;       ///< barycentric, of the triangle's second and third corner
    float area;       ///< mm^2
    float height;     ///< of its plane over the cell's center, mm, 0 or more
    float curvature;  ///< mean, 1/mm, above 0 where the body is convex
};

/// No sample's plane is farther over its cell's center, in cells.
constexpr double max_sample_height = 3.5;

struct BoundarySamples {
    std::vector<BoundarySample> samples;
    double lost_area = 0;  ///< of pieces at the flesh's own surface that no cell was found for, mm^2
    double area = 0;       ///< of all samples, mm^2
};

/// Triangles split to half a cell. Each piece goes to the cell nearest to half a cell below it, among those
/// that it is not clearly behind; walls inside flesh have none. Areas are those of the mesh, so that the
/// light that comes in does not know of the cells' stairs.
BoundarySamples boundary_samples(const FleshSurface& surface, const VoxelGrid& grid);

}  // namespace skinglow::detail
