#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "slab/layer_operators.h"

namespace skinglow::detail {

/// Everything below a plane, as seen from a medium above it: layers from top to bottom and the medium under
/// them. Built from the bottom up by adding layer after layer (van de Hulst 1980, ch. 4), each from its modes
/// and not by doubling, so that thick layers that hardly absorb lose nothing to rounding.
class LayerStack {
  public:
    /// @param n_from index of the medium the light comes from; the boundary to the first layer belongs to the
    /// stack.
    LayerStack(const StreamGrid& grid, double n_from, std::span<const Layer> layers, double n_below);

    /// Upward amplitudes in the medium above, from downward ones: streams of n_from squared.
    const Eigen::MatrixXd& reflection() const { return reflection_; }
    /// The amplitudes that leave into the medium below, from those that enter.
    Eigen::VectorXd transmit(const Eigen::VectorXd& downward) const;
    /// Per entering amplitude, what leaves, weighted by `leaving`: the transposed transmission.
    Eigen::VectorXd transmit_transposed(const Eigen::VectorXd& leaving) const;
    /// Flux that each layer absorbs, from the amplitudes that enter; not clamped.
    std::vector<double> absorbed(const Eigen::VectorXd& downward) const;

  private:
    struct Part {
        std::optional<Eigen::MatrixXd> into;     // across the upper boundary; none: indices are equal
        std::optional<Eigen::MatrixXd> through;  // across the layer; none: it is empty
        Eigen::MatrixXd reflection_top;          // of the layer and all below it, under its upper boundary
        Eigen::MatrixXd reflection_bottom;       // of all below the layer's lower face
        std::shared_ptr<const LayerModes> modes;
        double thickness = 0;
    };
    std::vector<Part> parts_;
    Eigen::MatrixXd out_;  // across the lowest boundary
    Eigen::MatrixXd reflection_;
    bool closed_ = false;  // a half-space ends the stack: nothing leaves below
};

/// True if the layer neither absorbs nor scatters: light crosses it unchanged, to rounding.
bool is_empty(const Layer& layer);

}  // namespace skinglow::detail
