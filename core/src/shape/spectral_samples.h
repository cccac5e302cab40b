#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

constexpr std::size_t max_spectral_nodes = 8;

/// Where a wavelength stands: before all nodes, between the two of its segment, or beyond all.
enum class NodeSide { before, between, beyond };

/// One wavelength among the nodes.
struct SpectralSample {
    std::array<double, max_spectral_nodes> weight{};  ///< of the nodes' logarithms; their sum is 1
    std::size_t segment = 0;                          ///< as in SpectralSamples::Run
    NodeSide side = NodeSide::between;
    glm::dmat3 matrix{0.0};  ///< what light of transmittance 1 contributes, times the epidermis' factor
};

/// The polynomial through values at the nodes, and straight lines beyond the first and the last.
class NodeInterpolation {
  public:
    /// @param at  positions of the nodes, ascending, two or more
    explicit NodeInterpolation(std::vector<double> at) : at_(std::move(at)) {}

    /// Weights, segment and whether the position lies between nodes; no matrix yet.
    SpectralSample at(double x) const;

  private:
    std::vector<double> at_;
};

/// A polynomial may oscillate between nodes that differ by orders of magnitude: it stays between its neighbors.
double value_of(const SpectralSample& sample, std::span<const double> at_nodes);

/// How wavelengths come about from the nodes. Those that stand alike to the nodes follow each other, a run,
/// and runs begin at multiples of a vector's length; between them are samples of no effect.
struct SpectralSamples {
    static constexpr std::size_t alignment = 16;  ///< samples; no vector holds more

    struct Run {
        std::size_t begin, end;
        std::size_t segment;  ///< the nodes `segment` and `segment` + 1 are next to them
        NodeSide side;
    };
    std::vector<Run> runs;
    std::size_t size = 0;
    /// For each node its weight by sample, then for each of 9 entries of the matrix, column by column, what
    /// the sample contributes where exitance is 1, times the epidermis' factor: rows of `size`.
    std::vector<float> rows;
};

SpectralSamples in_runs(std::span<const SpectralSample> samples, std::size_t nodes);

/// The sum of exp(logarithm at a sample) times its row, for each of 9 entries. Beyond the last node, which absorbs
/// most, nothing is brighter than there: noise of dim nodes would grow.
/// @param at_nodes  logarithms at the nodes, at most 0
/// @param limit     of a sample's logarithm before the first node
std::array<double, 9> sum_samples(const SpectralSamples& samples, std::span<const float> at_nodes,
                                  float limit);

}  // namespace skinglow::detail
