#pragma once

#include <array>
#include <span>

#include "shape/boundary_samples.h"
#include "shape/sp3_medium.h"
#include "shape/sparse_rows.h"

namespace skinglow::detail {

/// The right side of the equations as a matrix: rows are cells, columns vertices of the mesh given, whose
/// irradiance is taken as linear on triangles.
SparseRows<LanePair> boundary_light(const Body& body, const VoxelGrid& grid,
                                    std::span<const BoundarySample> samples, const LaneMedium& medium);

/// Of each mode, how much the fluence that is interpolated linearly between cells has. LastFlight corrects
/// for the first mode that a field lies below its interpolation; what the second, steeper one lies lower is
/// taken off here.
std::array<double, 2> seen_fluence(const Sp3Medium& medium, double cell);

/// Fluence outside the flesh, at centers of cells beside it, by going on beyond the surface as its condition
/// says: so that it can be interpolated up to the surface.
struct Ghosts {
    std::vector<std::int32_t> index;  ///< VoxelGrid::index with the ghosts' numbers, which follow the cells'
    SparseRows<LanePair> of_modes;    ///< fluence of each ghost from the modes of cells
    SparseRows<Lanes> of_light;       ///< and from the irradiance at vertices

    std::size_t bytes() const {
        return index.size() * sizeof(std::int32_t) + of_modes.bytes() + of_light.bytes();
    }
};

Ghosts make_ghosts(const Body& body, const VoxelGrid& grid, std::span<const BoundarySample> samples,
                   const LaneMedium& medium);

}  // namespace skinglow::detail
