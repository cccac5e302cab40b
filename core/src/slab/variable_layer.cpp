#include "slab/variable_layer.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "slab/layer_stack.h"

namespace skinglow::slab {
namespace {

// A mode is left out once it is behind the slowest one by exp(-37), the rounding of a double.
constexpr double negligible_depth = 37;

// Stands for nothing at all, in 1/mm: modes need a rate to decay at.
constexpr double least_attenuation = 1e-30;

Layer with_modes(Layer layer) {
    if (layer.absorption + layer.scattering < least_attenuation) {
        layer.absorption = least_attenuation;
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

// Load on the modes and, for a vector of amplitudes that meets the neighbor, its modal form without the
// load.
struct Neighbor {
    Eigen::MatrixXd load;
    Eigen::VectorXd excitation;
};
Neighbor neighbor(const LayerModes& modes, const Eigen::MatrixXd& reflection,
                  const Eigen::VectorXd& amplitudes) {
    const Eigen::Index n = reflection.rows();
    const Eigen::PartialPivLU<Eigen::MatrixXd> solver(Eigen::MatrixXd::Identity(n, n) + reflection);
    const Eigen::MatrixXd image = solver.solve(modes.shape);  // (1 + R)^-1 shape
    Eigen::MatrixXd load = modes.shape.transpose() * (image - reflection * image);
    load = (0.5 * (load + load.transpose())).eval();  // symmetric by reciprocity; now also in the last digit
    return {std::move(load), image.transpose() * amplitudes};
}

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

VariableLayer::VariableLayer(std::span<const Layer> layers, std::size_t variable, Incidence incidence,
                             double n_above, double n_below, int streams) {
    const bool symmetric = is_mirror_image(layers, variable, n_above, n_below);
    const auto grid = stream_grid(layers, incidence, n_above, n_below, streams);
    const Layer layer = with_modes(layers[variable]);
    const double n = layer.refractive_index;
    const LayerModes modes(layer, grid->basis(n));
    decay = to_vector(modes.decay);
    attenuation = layer.absorption + layer.scattering;

    // Each side as seen from inside the layer, outwards. What enters from above is, by reciprocity, weighted
    // as what would leave there.
    std::vector<Layer> above(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(variable));
    std::reverse(above.begin(), above.end());
    const LayerStack stack_above(*grid, n, above, n_above);
    Neighbor top =
        neighbor(modes, stack_above.reflection(), 2 * stack_above.transmit_transposed(grid->incident()));
    const Eigen::VectorXd leaving = grid->root_flux_weight().head(grid->count(n_below));
    Neighbor bottom;
    if (symmetric) {
        bottom = neighbor(modes, stack_above.reflection(), stack_above.transmit_transposed(leaving));
    } else {
        const LayerStack stack_below(*grid, n, layers.subspan(variable + 1), n_below);
        bottom = neighbor(modes, stack_below.reflection(), stack_below.transmit_transposed(leaving));
    }

    // One problem per mode left out, or per several where there are many modes: they take memory.
    const std::size_t step = std::max<std::size_t>(1, decay.size() / 16);
    for (std::size_t first = 0; first < decay.size(); ++first) {
        const auto p = static_cast<Eigen::Index>(first);
        const auto rest = static_cast<Eigen::Index>(decay.size()) - p;
        if (first % step == 0) {
            first_mode.push_back(first);
            problems.push_back({to_vector(modes.decay.tail(rest)), lower_triangle(top.load, p),
                                symmetric ? std::vector<double>{} : lower_triangle(bottom.load, p),
                                to_vector(top.excitation.tail(rest)),
                                to_vector(bottom.excitation.tail(rest))});
        }
        if (symmetric) {
            eliminate(p, decay[first], top.load, top.excitation, &bottom.excitation);
        } else {
            eliminate(p, decay[first], top.load, top.excitation, nullptr);
            eliminate(p, decay[first], bottom.load, bottom.excitation, nullptr);
        }
    }
}

const ModeProblem& VariableLayer::problem_for(double thickness) const {
    std::size_t chosen = 0;
    while (chosen + 1 < first_mode.size() &&
           (decay[first_mode[chosen + 1] - 1] - decay.back()) * thickness > negligible_depth) {
        ++chosen;
    }
    return problems[chosen];
}

}  // namespace skinglow::slab
