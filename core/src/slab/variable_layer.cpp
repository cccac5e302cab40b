#include "slab/variable_layer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/argument_check.h"
#include "slab/layer_stack.h"
#include "slab/stream_grid.h"

namespace skinglow {
namespace detail {
namespace {

// A mode is left out once it is behind the slowest one by exp(-37), the rounding of a double.
constexpr double negligible_depth = 37;

// Stands for nothing at all, in 1/mm: modes need a rate to decay at.
constexpr double min_attenuation = 1e-30;

Layer with_modes(Layer layer) {
    if (layer.absorption + layer.scattering < min_attenuation) {
        layer.absorption = min_attenuation;
        layer.scattering = 0;
    }
    return layer;
}

bool is_mirror_image(std::span<const Layer> layers, std::size_t variable, double n_above, double n_below) {
    if (n_above != n_below || 2 * variable + 1 != layers.size()) return false;
    for (std::size_t i = 0; i < variable; ++i) {
        if (!(layers[i] == layers[layers.size() - 1 - i])) return false;
    }
    return true;
}

// A neighbor of the layer, as its modes see it.
struct Neighbor {
    Eigen::MatrixXd load;
    /// (1 + R)^-1 shape: its transpose turns amplitudes that meet the neighbor into modal excitations.
    Eigen::MatrixXd image;

    Neighbor() = default;
    Neighbor(const Eigen::MatrixXd& shape, const Eigen::MatrixXd& reflection) {
        const Eigen::Index n = reflection.rows();
        const Eigen::PartialPivLU<Eigen::MatrixXd> solver(Eigen::MatrixXd::Identity(n, n) + reflection);
        image = solver.solve(shape);
        load.noalias() = shape.transpose() * (image - reflection * image);
        load = (0.5 * (load + load.transpose())).eval();  // symmetric by reciprocity; now in the last digit
    }
};

// Takes mode p, in its final state, out of the equations of the later ones.
void eliminate(Eigen::Index p, double k, Eigen::MatrixXd& load, Eigen::VectorXd& a, Eigen::VectorXd* b) {
    const Eigen::Index rest = load.rows() - p - 1;
    const Eigen::VectorXd factor = load.col(p).tail(rest) / (load(p, p) + k);
    a.tail(rest) -= factor * a[p];
    if (b != nullptr) b->tail(rest) -= factor * (*b)[p];
    load.bottomRightCorner(rest, rest) -= factor * load.row(p).tail(rest);
}

std::vector<double> to_vector(const Eigen::VectorXd& values) {
    return {values.begin(), values.end()};
}

std::vector<double> lower_triangle(const Eigen::MatrixXd& matrix, Eigen::Index first) {
    std::vector<double> entries;
    for (Eigen::Index i = first; i < matrix.rows(); ++i) {
        for (Eigen::Index j = first; j <= i; ++j) entries.push_back(matrix(i, j));
    }
    return entries;
}

}  // namespace

VariableLayer::VariableLayer(const StreamGrid& grid, std::span<const Layer> layers, std::size_t variable)
    : streams_(grid.streams()) {
    const bool symmetric = is_mirror_image(layers, variable, grid.n_above(), grid.n_below());
    const Layer layer = with_modes(layers[variable]);
    const double n = layer.refractive_index;
    Eigen::MatrixXd shape;
    const LayerModes modes(layer, grid.basis(n), &shape);
    decay_ = to_vector(modes.decay);
    attenuation_ = layer.absorption + layer.scattering;

    // Each side as seen from inside the layer, outwards. What enters from above is, by reciprocity, weighted
    // as what would leave there.
    std::vector<Layer> above(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(variable));
    std::reverse(above.begin(), above.end());
    const LayerStack stack_above(grid, n, above, grid.n_above());
    Neighbor top(shape, stack_above.reflection());
    Eigen::VectorXd source = 2 * top.image.transpose() * stack_above.transmit_transposed(grid.incident());
    const Eigen::VectorXd leaving = grid.root_flux_weight().head(grid.count(grid.n_below()));
    Neighbor bottom;
    Eigen::VectorXd receiver;
    if (symmetric) {
        receiver = top.image.transpose() * stack_above.transmit_transposed(leaving);
    } else {
        const LayerStack stack_below(grid, n, layers.subspan(variable + 1), grid.n_below());
        bottom = Neighbor(shape, stack_below.reflection());
        receiver = bottom.image.transpose() * stack_below.transmit_transposed(leaving);
    }

    // One problem per mode left out, or per several where there are many modes: they take memory.
    const std::size_t step = std::max<std::size_t>(1, decay_.size() / 16);
    for (std::size_t first = 0; first < decay_.size(); ++first) {
        const auto p = static_cast<Eigen::Index>(first);
        const auto rest = static_cast<Eigen::Index>(decay_.size()) - p;
        if (first % step == 0) {
            first_mode_.push_back(first);
            problems_.push_back({to_vector(modes.decay.tail(rest)), lower_triangle(top.load, p),
                                 symmetric ? std::vector<double>{} : lower_triangle(bottom.load, p),
                                 to_vector(source.tail(rest)), to_vector(receiver.tail(rest))});
        }
        if (symmetric) {
            eliminate(p, decay_[first], top.load, source, &receiver);
        } else {
            eliminate(p, decay_[first], top.load, source, nullptr);
            eliminate(p, decay_[first], bottom.load, receiver, nullptr);
        }
    }
}

const ModeProblem& VariableLayer::problem_for(double thickness_mm) const {
    std::size_t chosen = 0;
    while (chosen + 1 < first_mode_.size() &&
           (decay_[first_mode_[chosen + 1] - 1] - decay_.back()) * thickness_mm > negligible_depth) {
        ++chosen;
    }
    return problems_[chosen];
}

}  // namespace detail

ThicknessCurve::ThicknessCurve(std::span<const Layer> layers, std::size_t variable_layer, Incidence incidence,
                               double n_above, double n_below, int streams) {
    std::vector<Layer> stack(layers.begin(), layers.end());
    if (!stack.empty()) {
        if (variable_layer >= stack.size()) {
            refuse_argument("variable_layer", std::to_string(variable_layer),
                            "0 to " + std::to_string(stack.size() - 1));
        }
        stack[variable_layer].thickness = 0;
    }
    const StreamGrid grid(stack, incidence, n_above, n_below, streams);
    if (std::isinf(stack.back().thickness)) {
        refuse_argument("layers[" + std::to_string(stack.size() - 1) + "].thickness", "inf",
                        "a finite number of mm: nothing comes through a half-space");
    }
    layer_ = std::make_shared<const VariableLayer>(grid, stack, variable_layer);
}

double ThicknessCurve::transmittance(double thickness_mm) const {
    double out = 0;
    transmittance({&thickness_mm, 1}, {&out, 1});
    return out;
}

void ThicknessCurve::transmittance(std::span<const double> thickness_mm, std::span<double> out) const {
    require_count("out", out.size(), thickness_mm.size(), "one per thickness");
    for (const double d : thickness_mm) require_not_negative("thickness_mm", d);
    layer_->transmittance(thickness_mm, out);
}

double ThicknessCurve::decay_rate() const {
    return layer_->slowest_decay();
}

}  // namespace skinglow
