#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <vector>

#include "color/spectrum.h"
#include "skin/diffusion_approximation.h"
#include "skin/thickness_nodes.h"
#include "skin/tissue.h"

namespace skinglow {

/// ln T, or a correction to it, along a set of thicknesses; and one such row for each sample of the 5 nm
/// grid.
using ThicknessRow = std::vector<double>;
using ThicknessRows = std::array<ThicknessRow, spectral_samples>;

/// M at each of `count` thicknesses from ln T of every wavelength.
std::vector<glm::dmat3> matrices(const ThicknessRows& log_transmittance, std::size_t count);

/// Difference of two matrices in the norm of SkinLutReport.
double matrix_error(const glm::dmat3& matrix, const glm::dmat3& exact);
/// The largest of two rows of matrices.
double largest_error(const std::vector<glm::dmat3>& found, const std::vector<glm::dmat3>& exact);

/// Skin lit diffusely, solved at some thicknesses and wavelengths and filled in between. Diffusion theory
/// gives every wavelength and thickness; what it lacks, ln(solved / diffusion), is small and varies slowly.
/// Between the wavelengths that are solved it runs straight with the absorption of the inner layer (with
/// wavelength around the peaks of blood), between the thicknesses along splines.
class SampledSkin {
  public:
    /// @param share what a wavelength has to add to a column of M, as a part of it, so as to matter at a
    /// thickness
    SampledSkin(const Tissue& tissue, const ThicknessNodes& nodes, double share, int streams);

    /// Solves every `step`-th wavelength (1, 2, 4 or 8), and between them where that is not enough: each
    /// solved wavelength tells how far the straight line between its neighbors was off, and where that
    /// matters most both halves get one in their middle, until what is left is within `allowed`.
    /// @return bound on the error of M left by filling in, in the norm of SkinLutReport
    double solve(std::size_t step, double allowed);

    /// What diffusion theory lacks, at every wavelength and node.
    ThicknessRows correction() const;
    /// ln T along the nodes from such corrections.
    ThicknessRows log_transmittance(const ThicknessRows& correction) const;
    /// ln T at every entry of the nodes' table, from such corrections.
    ThicknessRows log_transmittance_at_entries(const ThicknessRows& correction) const;

    /// Largest relative difference of T that so many streams make, at some of the wavelengths that were
    /// solved.
    double stream_difference(int streams) const;

    std::size_t node_count() const { return count_; }
    std::vector<double> solved_nm() const;  ///< ascending
    std::size_t pairs_solved() const;
    std::size_t pairs_skipped() const;

  private:
    /// Samples between two solved ones, and how far off the line from first to last was at the solved one in
    /// the middle.
    struct Gap {
        std::size_t first, last;
        double surprise;
    };
    Gap solved_gap(std::size_t first, std::size_t last, double whole);
    void solve_sample(std::size_t k);
    double place_between(std::size_t k, std::size_t first, std::size_t last) const;
    ThicknessRow solved_log_transmittance(std::size_t k, std::size_t reach, int streams) const;
    void find_reach(double share);
    std::vector<std::size_t> solved() const;

    Tissue tissue_;
    const ThicknessNodes& nodes_;
    int streams_;
    std::size_t count_;
    std::vector<DiffusionCurve> curves_;
    ThicknessRows diffusion_, correction_;
    Spectrum absorption_{};          // of the inner layer, on the scale on which the correction runs straight
    std::vector<glm::dvec3> scale_;  // at each node, what the error of each column is measured by
    std::array<std::size_t, spectral_samples>
        reach_{};  // nodes, from the thinnest, at which each wavelength matters
};

}  // namespace skinglow
