#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shape/boundary_samples.h"
#include "shape/sp3_medium.h"

namespace skinglow::detail {

/// The equations of all cells, for all nodes side by side: finite volumes of 7 points, whose fluxes between
/// cells are exact for a field that falls as exp(-decay x), with the surface's condition at its true height
/// over the cell's center, exact in the same way (SurfaceLink). Each mode's equations are those of the
/// volumes divided by (x / 2) coth(x / 2), x = decay times cell, so that they are the exact ones of one
/// dimension. Symmetric and positive.
class Sp3System {
  public:
    /// @param margin  how far flesh goes on at least behind a cut, mm
    Sp3System(const VoxelGrid& grid, std::span<const BoundarySample> samples, const LaneMedium& medium,
              double margin);

    std::uint32_t size() const { return static_cast<std::uint32_t>(class_of_.size()); }

    /// Solves for the modes by conjugate gradients with a symmetric, over-relaxed Gauss-Seidel sweep over the cells
    /// as preconditioner; each node stops when its residual, in the preconditioner's norm, is below
    /// the tolerance times the right side's.
    /// @param right  one per cell
    /// @param modes  one per cell and one of zeros at the end
    /// @return iterations
    int solve(std::span<const LanePair> right, std::span<LanePair> modes, double tolerance) const;

    std::size_t bytes() const {
        return class_of_.size() * sizeof(std::uint32_t) + neighbors_.size() * sizeof(neighbors_[0]) +
               blocks_.size() * sizeof(Block);
    }

  private:
    /// The diagonal block of a cell and its inverse times the relaxation, symmetric.
    struct Block {
        Lanes d11, d12, d22;
        Lanes i11, i12, i22;
    };
    /// One cell's unknowns of the equations' lower triangle, the cells before it being known. In the class, as all
    /// below, for the compiler to put it into the loops over cells.
    void solve_lower(std::size_t c, const LanePair& right, std::span<LanePair> result) const {
        const auto& n = neighbors_[c];
        // Those before this cell; n may be the cell of zeros at the end.
        const LanePair around = sum_of(result, n[0], n[2], n[4]);
        result[c] =
            solve_block(c, right.first + flux1_ * around.first, right.second + flux2_ * around.second);
    }
    static LanePair sum_of(std::span<const LanePair> x, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return {x[a].first + x[b].first + x[c].first, x[a].second + x[b].second + x[c].second};
    }
    LanePair solve_block(std::size_t c, const Lanes& u, const Lanes& w) const {
        const Block& b = blocks_[class_of_[c]];
        return {b.i11 * u + b.i12 * w, b.i12 * u + b.i22 * w};
    }
    LanePair diagonal(std::size_t c, const LanePair& x) const {
        const Block& b = blocks_[class_of_[c]];
        return {b.d11 * x.first + b.d12 * x.second, b.d12 * x.first + b.d22 * x.second};
    }

    Lanes flux1_, flux2_;        ///< between neighbors, mm
    std::vector<Block> blocks_;  ///< the first is that of cells amid others
    std::vector<std::uint32_t> class_of_;
    std::vector<std::array<std::uint32_t, 6>> neighbors_;
};

}  // namespace skinglow::detail
