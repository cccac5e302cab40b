#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "numerics/cubic_spline.h"

namespace skinglow {

/// Where skin is solved so that what diffusion theory lacks of it can be interpolated at every entry of a
/// table.
///
/// Transmittance has a kink where the skin is just its two epidermes, so that there are two stretches, below
/// and above. In each the nodes are even in u, thickness = start + scale * ((1 + length / scale)^u - 1):
/// close together where the light is not yet diffuse, wide apart where ln T is almost straight. A stretch
/// with no more entries than nodes is solved at its entries, and nothing is interpolated there.
class ThicknessNodes {
  public:
    /// @param entries_mm ascending; @param kink_mm 0 or more; @param scale_mm above 0: about a mean free path
    /// @param count nodes in each stretch, odd, 5 or more
    ThicknessNodes(std::span<const double> entries_mm, double kink_mm, double scale_mm, std::size_t count);

    std::span<const double> entries_mm() const { return entries_; }
    std::span<const double> thickness_mm() const { return nodes_; }
    bool is_exact() const;  ///< every entry is a node

    /// @param at_nodes one value per node; @param at_entries one per entry
    void to_entries(std::span<const double> at_nodes, std::span<double> at_entries) const;

    /// The embedded check: what every second node predicts at the nodes between. Nodes that are not predicted
    /// keep their value. @param predicted one per node
    void predict_from_half(std::span<const double> at_nodes, std::span<double> predicted) const;

  private:
    struct Stretch {
        std::size_t first_node, node_count, first_entry, entry_count;
        std::optional<CubicSpline> cubic, half;  // none: nodes are entries
    };
    void add_stretch(std::span<const double> entries_mm, std::size_t first, std::size_t last, double start,
                     double end, double scale_mm, std::size_t count);

    std::vector<double> entries_, nodes_;
    std::vector<Stretch> stretches_;
};

}  // namespace skinglow
