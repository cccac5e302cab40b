#include "slab/layer_stack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace skinglow::detail {

bool is_empty(const Layer& layer) {
    // Thinner than this, optically, is transparent to rounding, and its reciprocals could overflow.
    constexpr double min_depth = 1e-30;
    return (layer.absorption + layer.scattering) * layer.thickness < min_depth || layer.thickness == 0;
}

LayerStack::LayerStack(const StreamGrid& grid, double n_from, std::span<const Layer> layers, double n_below)
    : levels_(layers.size()) {
    const auto index_above = [&](std::size_t i) { return i == 0 ? n_from : layers[i - 1].refractive_index; };
    const Crossing lowest = cross_boundary(grid, index_above(layers.size()), n_below, {});
    out_ = lowest.transmission;
    Eigen::MatrixXd below = lowest.reflection;
    for (std::size_t i = layers.size(); i-- > 0;) {
        const Layer& layer = layers[i];
        Level& level = levels_[i];
        level.thickness = layer.thickness;
        if (!is_empty(layer)) {
            // Layers of one medium, the two epidermes of an ear for one, share their modes.
            for (std::size_t j = i + 1; j < layers.size() && !level.modes; ++j) {
                Layer same = layers[j];
                same.thickness = layer.thickness;
                if (same == layer) level.modes = levels_[j].modes;
            }
            if (!level.modes) {
                level.modes = std::make_shared<const LayerModes>(layer, grid.basis(layer.refractive_index));
            }
            const LayerOperators own = layer_operators(*level.modes, layer.thickness);
            if (std::isinf(layer.thickness)) {
                closed_ = true;
                below = own.reflection;
            } else {
                level.reflection_bottom = below;
                Crossing crossing = cross_layer(own, below);
                level.through = std::move(crossing.transmission);
                below = std::move(crossing.reflection);
            }
        }
        level.reflection_top = below;
        const double n_above = index_above(i);
        if (n_above != layer.refractive_index) {
            Crossing crossing = cross_boundary(grid, n_above, layer.refractive_index, below);
            level.into = std::move(crossing.transmission);
            below = std::move(crossing.reflection);
        }
    }
    reflection_ = std::move(below);
}

Eigen::VectorXd LayerStack::transmit(const Eigen::VectorXd& downward) const {
    if (closed_) return Eigen::VectorXd::Zero(out_.rows());
    Eigen::VectorXd light = downward;
    for (const Level& level : levels_) {
        if (level.into) light = *level.into * light;
        if (level.through) light = *level.through * light;
    }
    return out_ * light;
}

Eigen::VectorXd LayerStack::transmit_transposed(const Eigen::VectorXd& leaving) const {
    Eigen::VectorXd weight = out_.transpose() * leaving;
    std::for_each(levels_.rbegin(), levels_.rend(), [&](const Level& level) {
        if (level.through) weight = level.through->transpose() * weight;
        if (level.into) weight = level.into->transpose() * weight;
    });
    if (closed_) weight.setZero();
    return weight;
}

std::vector<double> LayerStack::absorbed(const Eigen::VectorXd& downward) const {
    std::vector<double> absorbed;
    Eigen::VectorXd light = downward;
    for (const Level& level : levels_) {
        if (level.into) light = *level.into * light;
        if (!level.modes) {
            absorbed.push_back(0);
            continue;
        }
        // The absorbed flux is what the net flux loses, but taken from the modes: the difference of two net
        // fluxes would be rounding alone in a layer that hardly absorbs.
        const LayerModes& modes = *level.modes;
        Eigen::VectorXd sum = light + level.reflection_top * light;
        Eigen::VectorXd lost = modes.decay;
        if (level.through) {
            light = *level.through * light;
            sum += light + level.reflection_bottom * light;
            lost = mode_factors(modes.decay, level.thickness).symmetric;
        }
        const Eigen::VectorXd coefficients = modes.dual.transpose() * sum;
        absorbed.push_back(modes.net_flux.cwiseProduct(lost).dot(coefficients));
    }
    return absorbed;
}

}  // namespace skinglow::detail
