#include "shape/sp3_system.h"

#include <algorithm>
#include <cmath>

#include "numerics/job.h"

namespace skinglow::detail {
namespace {

constexpr int max_iterations = 2000;
/// Cells summed in single precision before they are added in double.
constexpr std::size_t sum_block = 256;
/// Decay times cell below which a field counts as constant: keeps the system definite without absorption.
constexpr double least_decay = 1e-5;
/// Of the preconditioner's sweeps: between 1, which is Gauss-Seidel, and 2.
constexpr float over_relaxation = 1.3F;

using LaneSum = std::array<double, lane_count>;

/// The flux between two cells per difference, of a field that falls with x = decay h: h x / sinh x.
double flux_factor(double x, double h) {
    return x < 1e-3 ? h * (1 - x * x / 6) : (x > 500 ? 0.0 : h * x / std::sinh(x));
}

/// A sum over cells, in single precision for some, then in double.
class CellSum {
  public:
    void add(std::size_t cell, const LanePair& a, const LanePair& b) {
        part_ += a.first * b.first + a.second * b.second;
        if (cell % sum_block == 0) flush();
    }
    const LaneSum& total() {
        flush();
        return total_;
    }

  private:
    void flush() {
        for (std::size_t k = 0; k < lane_count; ++k) total_[k] += static_cast<double>(part_[k]);
        part_ = {};
    }
    LaneSum total_{};
    Lanes part_;
};

}  // namespace

Sp3System::Sp3System(const VoxelGrid& grid, std::span<const BoundarySample> samples, const LaneMedium& medium,
                     double margin)
    : class_of_(grid.size(), 0), neighbors_(grid.size()) {
    const auto h = static_cast<double>(grid.cell());
    struct Sums {
        std::array<double, lane_count> d11{}, d12{}, d22{};  // of the block
        std::array<double, lane_count> r1{}, r2{};           // change of the reaction at the surface
    };
    std::array<double, lane_count> flux[2];
    std::array<std::array<double, lane_count>, 2> half_cell{};
    for (std::size_t k = 0; k < lane_count; ++k) {
        for (int i = 0; i < 2; ++i) {
            flux[i][k] = flux_factor(medium[k].decay[i] * h, h);
            half_cell[static_cast<std::size_t>(i)][k] = std::tanh(0.5 * medium[k].decay[i] * h);
        }
    }
    flux1_ = each_lane([&](std::size_t k) { return static_cast<float>(flux[0][k]); });
    flux2_ = each_lane([&](std::size_t k) { return static_cast<float>(flux[1][k]); });
    const auto inner = [&](int neighbors, int cuts) {
        Sums sums;
        for (std::size_t k = 0; k < lane_count; ++k) {
            for (int i = 0; i < 2; ++i) {
                const double m = std::max(medium[k].decay[i], least_decay / h);
                const double half = std::tanh(0.5 * m * h);
                // Behind a cut the field falls as in endless flesh, or as 1 / r at the margin's end.
                const double behind = std::max(m, 1 / margin);
                (i == 0 ? sums.d11 : sums.d22)[k] =
                    2 * h * h * m * half + neighbors * flux[i][k] + cuts * h * h * behind * (1 - half);
            }
        }
        return sums;
    };
    std::vector<Sums> sums{inner(6, 0)};
    std::vector<std::uint8_t> is_special(grid.size(), 0);
    for (const BoundarySample& s : samples) is_special[s.cell] = 1;
    for (std::uint32_t c = 0; c < grid.size(); ++c) {
        stop_if_asked(c);
        neighbors_[c] = grid.neighbors(c).cell;
        const auto count = std::count_if(neighbors_[c].begin(), neighbors_[c].end(),
                                         [&](std::uint32_t n) { return n < grid.size(); });
        if (is_special[c] == 0 && count == 6) continue;
        class_of_[c] = static_cast<std::uint32_t>(sums.size());
        sums.push_back(inner(static_cast<int>(count), grid.neighbors(c).cuts));
    }
    const SurfaceLinks links(medium, max_sample_height * h);
    for (std::size_t n = 0; n < samples.size(); ++n) {
        stop_if_asked(n);
        const BoundarySample& s = samples[n];
        Sums& sum = sums[class_of_[s.cell]];
        const auto area = static_cast<double>(s.area);
        for (std::size_t k = 0; k < lane_count; ++k) {
            const SurfaceLink& link = links.at(k, s.height, s.curvature);
            sum.d11[k] += area * link.block(0);
            sum.d12[k] += area * link.block(1);
            sum.d22[k] += area * link.block(2);
            // Between cell and surface there is this much more or less than half a cell that reacts.
            const auto change = [&](int i) {
                const double m = medium[k].decay[i];
                return area * m * (m * link.depth[i] - half_cell[static_cast<std::size_t>(i)][k]);
            };
            sum.r1[k] += change(0);
            sum.r2[k] += change(1);
        }
    }
    // Where surfaces on all sides belong to one cell, little of it is flesh; some is.
    constexpr double least_flesh = 0.1;
    for (Sums& s : sums) {
        for (std::size_t k = 0; k < lane_count; ++k) {
            const auto limited = [&](int i, double change) {
                const double m = std::max(medium[k].decay[i], least_decay / h);
                const double full = 2 * h * h * m * std::tanh(0.5 * m * h);
                return std::max(change, (least_flesh - 1) * full);
            };
            s.d11[k] += limited(0, s.r1[k]);
            s.d22[k] += limited(1, s.r2[k]);
        }
    }
    blocks_.reserve(sums.size());
    for (const Sums& s : sums) {
        Block block;
        for (std::size_t k = 0; k < lane_count; ++k) {
            const double scale =
                static_cast<double>(over_relaxation) / (s.d11[k] * s.d22[k] - s.d12[k] * s.d12[k]);
            block.d11[k] = static_cast<float>(s.d11[k]);
            block.d12[k] = static_cast<float>(s.d12[k]);
            block.d22[k] = static_cast<float>(s.d22[k]);
            block.i11[k] = static_cast<float>(s.d22[k] * scale);
            block.i12[k] = static_cast<float>(-s.d12[k] * scale);
            block.i22[k] = static_cast<float>(s.d11[k] * scale);
        }
        blocks_.push_back(block);
    }
}

int Sp3System::solve(std::span<const LanePair> right, std::span<LanePair> modes, double tolerance) const {
    // With A = K + K^T - (2 - w) D / w, K the lower triangle with the diagonal D / w, the preconditioned matrix is
    // K^-1 A K^-T = K^-T + K^-1 (1 - (2 - w) D / w K^-T): two sweeps, no product with A (S. C. Eisenstat, "Efficient
    // implementation of a class of preconditioned conjugate gradient methods", SIAM J. Sci. Stat. Comput. 2(1),
    // 1981). All vectors but the modes are of that system.
    const std::size_t count = class_of_.size();
    std::fill(modes.begin(), modes.end(), LanePair{});
    std::vector<LanePair> residual(modes.size());
    std::vector<LanePair> direction(count);
    std::vector<LanePair> above(modes.size());  // K^-T direction
    std::vector<LanePair> below(
        modes.size());  // (1 - (2 - w) D / w K^-T) direction, and then K^-1 of that in its place
    CellSum first;
    for (std::size_t c = 0; c < count; ++c) {
        solve_lower(c, right[c], residual);
        first.add(c, residual[c], diagonal(c, residual[c]));
    }
    const LaneSum start = first.total();
    LaneSum rz = start;
    Lanes keep;
    int iteration = 0;
    for (; iteration < max_iterations; ++iteration) {
        stop_if_asked();
        Lanes is_open;
        bool any = false;
        for (std::size_t k = 0; k < lane_count; ++k) {
            const bool open = rz[k] > tolerance * tolerance * start[k];
            is_open[k] = open ? 1.0F : 0.0F;
            any = any || open;
        }
        if (!any) break;
        for (std::size_t c = count; c-- > 0;) {
            const auto& n = neighbors_[c];
            const LanePair around = sum_of(above, n[1], n[3], n[5]);
            const LanePair z = diagonal(c, residual[c]);
            LanePair& d = direction[c];
            d = {z.first + keep * d.first, z.second + keep * d.second};
            const LanePair from = {flux1_ * around.first, flux2_ * around.second};
            above[c] = solve_block(c, d.first + from.first, d.second + from.second);
            below[c] = d * (over_relaxation - 1);
            below[c] += from * (over_relaxation - 2);
        }
        CellSum sum;
        for (std::size_t c = 0; c < count; ++c) {
            solve_lower(c, below[c], below);
            sum.add(c, direction[c], {above[c].first + below[c].first, above[c].second + below[c].second});
        }
        const LaneSum curvature = sum.total();
        const Lanes step = each_lane([&](std::size_t k) {
            return is_open[k] > 0 && curvature[k] > 0 ? static_cast<float>(rz[k] / curvature[k]) : 0.0F;
        });
        CellSum next_sum;
        for (std::size_t c = 0; c < count; ++c) {
            const LanePair& a = above[c];
            modes[c] += {step * a.first, step * a.second};
            LanePair& r = residual[c];
            r = {r.first - step * (a.first + below[c].first), r.second - step * (a.second + below[c].second)};
            next_sum.add(c, r, diagonal(c, r));
        }
        const LaneSum next = next_sum.total();
        keep = each_lane([&](std::size_t k) {
            return is_open[k] > 0 && rz[k] > 0 ? static_cast<float>(next[k] / rz[k]) : 0.0F;
        });
        for (std::size_t k = 0; k < lane_count; ++k) {
            if (is_open[k] > 0) rz[k] = next[k];
        }
    }
    return iteration;
}

}  // namespace skinglow::detail
