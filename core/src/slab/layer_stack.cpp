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
    : parts_(layers.size()) {
    const auto index_above = [&](std::size_t i) { return i == 0 ? n_from : layers[i - 1].refractive_index; };
    const Crossing lowest = cross_boundary(grid, index_above(layers.size()), n_below, {});
    out_ = lowest.transmission;
    Eigen::MatrixXd below = lowest.reflection;
    for (std::size_t i = layers.size(); i-- > 0;) {
        const Layer& layer = layers[i];
        Part& part = parts_[i];
        part.thickness = layer.thickness;
        if (!is_empty(layer)) {
            // Layers of one medium, the two epidermes of an ear for one, share their modes.
            for (std::size_t j = i + 1; j < layers.size() && !part.modes; ++j) {
                Layer same = layers[j];
                same.thickness = layer.thickness;
                if (same == layer) part.modes = parts_[j].modes;
            }
            if (!part.modes) {
                part.modes = std::make_shared<const LayerModes>(layer, grid.basis(layer.refractive_index));
            }
            const LayerOperators own = layer_operators(*part.modes, layer.thickness);
            if (std::isinf(layer.thickness)) {
                closed_ = true;
                below = own.reflection;
            } else {
                part.reflection_bottom = below;
                Crossing crossing = cross_layer(own, below);
                part.through = std::move(crossing.transmission);
                below = std::move(crossing.reflection);
            }
        }
        part.reflection_top = below;
        const double n_above = index_above(i);
        if (n_above != layer.refractive_index) {
            Crossing crossing = cross_boundary(grid, n_above, layer.refractive_index, below);
            part.into = std::move(crossing.transmission);
            below = std::move(crossing.reflection);
        }
    }
    reflection_ = std::move(below);
}

Eigen::VectorXd LayerStack::transmit(const Eigen::VectorXd& downward) const {
    if (closed_) return Eigen::VectorXd::Zero(out_.rows());
    Eigen::VectorXd light = downward;
    for (const Part& part : parts_) {
        if (part.into) light = *part.into * light;
        if (part.through) light = *part.through * light;
    }
    return out_ * light;
}

Eigen::VectorXd LayerStack::transmit_transposed(const Eigen::VectorXd& leaving) const {
    Eigen::VectorXd weight = out_.transpose() * leaving;
    std::for_each(parts_.rbegin(), parts_.rend(), [&](const Part& part) {
        if (part.through) weight = part.through->transpose() * weight;
        if (part.into) weight = part.into->transpose() * weight;
    });
    if (closed_) weight.setZero();
    return weight;
}

std::vector<double> LayerStack::absorbed(const Eigen::VectorXd& downward) const {
    std::vector<double> absorbed;
    Eigen::VectorXd light = downward;
    for (const Part& part : parts_) {
        if (part.into) light = *part.into * light;
        if (!part.modes) {
            absorbed.push_back(0);
            continue;
        }
        // The absorbed flux is what the net flux loses, but taken from the modes: the difference of two net
        // fluxes would be rounding alone in a layer that hardly absorbs.
        const LayerModes& modes = *part.modes;
        Eigen::VectorXd sum = light + part.reflection_top * light;
        Eigen::VectorXd lost = modes.decay;
        if (part.through) {
            light = *part.through * light;
            sum += light + part.reflection_bottom * light;
            lost = mode_factors(modes.decay, part.thickness).symmetric;
        }
        const Eigen::VectorXd coefficients = modes.dual.transpose() * sum;
        absorbed.push_back(modes.net_flux.cwiseProduct(lost).dot(coefficients));
    }
    return absorbed;
}

}  // namespace skinglow::detail
