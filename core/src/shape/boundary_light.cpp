#include "shape/boundary_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "numerics/job.h"

namespace skinglow::detail {
namespace {

/// A ghost takes what lies within this distance of it along the surface, squared, in cells.
constexpr float max_aside_sq = 1.2F;
/// And of that the nearest almost alone, by distance in all directions, squared, in cells. A wider mean carries light
/// over the edge of a shadow, by up to four tenths of the error in blue; and distance along the surface alone takes
/// light over a narrow fold from one wall to the other, which doubled the error in blue.
constexpr float narrowness = 20;
/// Squared distances beyond the nearest, in cells, whose weight of 5e-6 is nothing.
constexpr float max_farther_sq = 0.6F;

/// Decay times height up to which a field is followed beyond the surface.
constexpr double max_rise = 1.5;

/// Indices of samples, grouped by a key from 0 to `count`.
class Groups {
  public:
    template <typename Key>
    Groups(std::size_t items, std::size_t count, const Key& key) : begin_(count + 1, 0), item_(items) {
        for (std::uint32_t i = 0; i < items; ++i) ++begin_[key(i) + 1];
        for (std::size_t g = 1; g <= count; ++g) begin_[g] += begin_[g - 1];
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t i = 0; i < items; ++i) item_[next[key(i)]++] = i;
    }
    std::span<const std::uint32_t> at(std::size_t group) const {
        return {item_.data() + begin_[group], begin_[group + 1] - begin_[group]};
    }

  private:
    std::vector<std::uint32_t> begin_;
    std::vector<std::uint32_t> item_;
};

std::array<float, 3> weights_of(const BoundarySample& s) {
    return {1 - s.u - s.v, s.u, s.v};
}

std::size_t vertices_of(const Body& body) {
    return body.welded_of().size();
}

/// A ghost that leans on a sample.
struct Lean {
    std::uint32_t ghost;
    std::uint32_t sample;
    float area;         ///< mm^2
    float distance_sq;  ///< of the ghost from the sample, in cells
    float height;       ///< of the ghost over the sample's plane, mm, 0 or more
};

std::vector<Lean> find_leans(const Body& body, const VoxelGrid& grid, std::span<const BoundarySample> samples,
                             std::vector<std::int32_t>& index, std::vector<float>& nearest_sq) {
    std::vector<Lean> leans;
    const float h = grid.cell();
    std::array<glm::ivec3, 27> steps;
    std::array<std::ptrdiff_t, 27> strides{};
    for (int n = 0; n < 27; ++n) {
        const auto k = static_cast<std::size_t>(n);
        steps[k] = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        strides[k] = static_cast<std::ptrdiff_t>(grid.linear(steps[k] + 1)) -
                     static_cast<std::ptrdiff_t>(grid.linear(glm::ivec3(1)));
    }
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        stop_if_asked(i);
        const BoundarySample& s = samples[i];
        const BodyTriangle& t = body.triangles()[s.triangle];
        const glm::vec3 point = body.at(t, s.u, s.v);
        const glm::ivec3 middle = grid.voxel_of(point);
        const glm::vec3 to_middle = grid.center_of(middle) - point;
        const bool is_amid = grid.has(middle - 1) && grid.has(middle + 1);
        for (std::size_t n = 0; n < steps.size(); ++n) {
            if (!is_amid && !grid.has(middle + steps[n])) continue;
            const auto voxel =
                static_cast<std::size_t>(static_cast<std::ptrdiff_t>(grid.linear(middle)) + strides[n]);
            if (grid.index()[voxel] != VoxelGrid::outside) continue;
            const glm::vec3 off = to_middle + glm::vec3(steps[n]) * h;
            const float height = std::max(0.0F, glm::dot(off, t.normal));
            const float aside_sq = glm::dot(off, off) - height * height;
            if (aside_sq > max_aside_sq * h * h) continue;
            std::int32_t& number = index[voxel];
            if (number < 0) {
                number = static_cast<std::int32_t>(grid.size() + nearest_sq.size());
                nearest_sq.push_back(std::numeric_limits<float>::infinity());
            }
            const std::uint32_t ghost = static_cast<std::uint32_t>(number) - grid.size();
            const float distance_sq = glm::dot(off, off) / (h * h);
            if (distance_sq > nearest_sq[ghost] + max_farther_sq) continue;
            nearest_sq[ghost] = std::min(nearest_sq[ghost], distance_sq);
            leans.push_back({ghost, i, s.area, distance_sq, height});
        }
    }
    std::erase_if(
        leans, [&](const Lean& lean) { return lean.distance_sq > nearest_sq[lean.ghost] + max_farther_sq; });
    return leans;
}

/// Linear interpolation between cells lies above a field that falls with x = decay times cell by (x / 2)
/// coth(x / 2) in the mean.
double above_field(double x) {
    return x < 1e-3 ? 1 + x * x / 12 : 0.5 * x / std::tanh(0.5 * x);
}

}  // namespace

std::array<double, 2> seen_fluence(const Sp3Medium& medium, double cell) {
    const double ratio = above_field(medium.decay[0] * cell) / above_field(medium.decay[1] * cell);
    return {medium.fluence[0], medium.fluence[1] * ratio};
}

namespace {

/// How the seen fluence goes on over the surface, by height.
class RiseTable {
  public:
    struct Rise {
        double cosh[2];  ///< seen fluence of a mode times cosh(decay height)
        double sinh[2];  ///< times sinh(decay height) / decay, mm
    };

    RiseTable(const LaneMedium& medium, double cell)
        : bins_per_mm_(static_cast<float>(static_cast<double>(bins) / (max_cells * cell))) {
        for (std::size_t b = 0; b <= bins; ++b) {
            const double height = max_cells * cell * static_cast<double>(b) / bins;
            for (std::size_t k = 0; k < lane_count; ++k) {
                const std::array<double, 2> seen = seen_fluence(medium[k], cell);
                Rise rise{};
                for (std::size_t i = 0; i < 2; ++i) {
                    const double decay = medium[k].decay[i];
                    const double x = std::min(decay * height, max_rise);
                    rise.cosh[i] = seen[i] * std::cosh(x);
                    rise.sinh[i] = seen[i] * (x < 1e-6 ? height : std::sinh(x) / decay);
                }
                rises_.push_back(rise);
            }
        }
    }
    const Rise& at(std::size_t lane, float height) const {
        const auto bin = static_cast<std::size_t>(std::min(height * bins_per_mm_ + 0.5F, float{bins}));
        return rises_[bin * lane_count + lane];
    }

  private:
    static constexpr std::size_t bins = 500;
    static constexpr double max_cells = 3;  ///< a ghost is among the neighbors of the cell of a sample
    float bins_per_mm_;
    std::vector<Rise> rises_;
};

}  // namespace

SparseRows<LanePair> boundary_light(const Body& body, const VoxelGrid& grid,
                                    std::span<const BoundarySample> samples, const LaneMedium& medium) {
    const Groups by_cell(samples.size(), grid.size(), [&](std::uint32_t i) { return samples[i].cell; });
    const SurfaceLinks links(medium, max_sample_height * static_cast<double>(grid.cell()));
    RowSums<LanePair> sums(vertices_of(body));
    SparseRows<LanePair> rows;
    for (std::uint32_t c = 0; c < grid.size(); ++c) {
        stop_if_asked(c);
        for (const std::uint32_t i : by_cell.at(c)) {
            const BoundarySample& s = samples[i];
            LanePair part;
            for (std::size_t k = 0; k < lane_count; ++k) {
                const SurfaceLink& link = links.at(k, s.height, s.curvature);
                part.first[k] = static_cast<float>(link.right(0)) * s.area;
                part.second[k] = static_cast<float>(link.right(1)) * s.area;
            }
            const std::array<float, 3> weights = weights_of(s);
            for (int k = 0; k < 3; ++k)
                sums.at(body.triangles()[s.triangle].corners[k]) +=
                    part * weights[static_cast<std::size_t>(k)];
        }
        sums.take([&](std::uint32_t vertex, const LanePair& value) { rows.add(vertex, value); });
        rows.end_row();
    }
    rows.shrink();
    return rows;
}

Ghosts make_ghosts(const Body& body, const VoxelGrid& grid, std::span<const BoundarySample> samples,
                   const LaneMedium& medium) {
    Ghosts result{grid.index(), {}, {}};
    std::vector<float> nearest_sq;
    const std::vector<Lean> leans = find_leans(body, grid, samples, result.index, nearest_sq);
    const auto count = static_cast<std::uint32_t>(nearest_sq.size());
    const Groups by_ghost(leans.size(), count, [&](std::uint32_t i) { return leans[i].ghost; });
    const SurfaceLinks links(medium, max_sample_height * static_cast<double>(grid.cell()));
    const RiseTable rises(medium, static_cast<double>(grid.cell()));
    RowSums<LanePair> of_modes(grid.size());
    RowSums<Lanes> of_light(vertices_of(body));
    for (std::uint32_t g = 0; g < count; ++g) {
        stop_if_asked(g);
        const auto weight_of = [&](const Lean& lean) {
            return lean.area * std::exp(narrowness * (nearest_sq[g] - lean.distance_sq));
        };
        float total = 0;
        for (const std::uint32_t i : by_ghost.at(g)) total += weight_of(leans[i]);
        for (const std::uint32_t i : by_ghost.at(g)) {
            const Lean& lean = leans[i];
            const BoundarySample& s = samples[lean.sample];
            const float weight = weight_of(lean) / total;
            LanePair modes;
            Lanes light;
            for (std::size_t k = 0; k < lane_count; ++k) {
                const SurfaceLink& link = links.at(k, s.height, s.curvature);
                // psi over the surface, cosh(decay height) psi_surface - sinh(decay height) / decay F, is
                // this of psi_i below it and that of F_i.
                const RiseTable::Rise& rise = rises.at(k, lean.height);
                double of_flux[2];
                double of_psi[2];
                for (std::size_t n = 0; n < 2; ++n) {
                    of_psi[n] = rise.cosh[n] * link.falloff[n];
                    of_flux[n] = -(rise.cosh[n] * link.depth[n] + rise.sinh[n]);
                }
                modes.first[k] = static_cast<float>(of_psi[0] + of_flux[0] * link.flux[0][0] +
                                                    of_flux[1] * link.flux[1][0]);
                modes.second[k] = static_cast<float>(of_psi[1] + of_flux[0] * link.flux[0][1] +
                                                     of_flux[1] * link.flux[1][1]);
                light[k] = static_cast<float>(-of_flux[0] * link.source[0] - of_flux[1] * link.source[1]);
            }
            of_modes.at(s.cell) += modes * weight;
            const std::array<float, 3> weights = weights_of(s);
            for (int k = 0; k < 3; ++k) {
                of_light.at(body.triangles()[s.triangle].corners[k]) +=
                    light * (weight * weights[static_cast<std::size_t>(k)]);
            }
        }
        of_modes.take([&](std::uint32_t cell, const LanePair& value) { result.of_modes.add(cell, value); });
        of_light.take([&](std::uint32_t vertex, const Lanes& value) { result.of_light.add(vertex, value); });
        result.of_modes.end_row();
        result.of_light.end_row();
    }
    result.of_modes.shrink();
    result.of_light.shrink();
    return result;
}

}  // namespace skinglow::detail
