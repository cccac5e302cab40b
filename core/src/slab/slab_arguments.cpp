#include "slab/slab_arguments.h"

#include <cmath>
#include <string>

#include "numerics/argument_check.h"

namespace skinglow::slab {
namespace {

void check_index(const std::string& name, double n) {
    if (!std::isfinite(n) || n < 1) refuse_argument(name, to_text(n), "a finite number, 1 or more");
}

void check_layer(std::span<const Layer> layers, std::size_t i) {
    const Layer& layer = layers[i];
    const std::string name = "layers[" + std::to_string(i) + "].";
    check_index(name + "refractive_index", layer.refractive_index);
    require_not_negative(name + "absorption", layer.absorption);
    require_not_negative(name + "scattering", layer.scattering);
    if (!std::isfinite(layer.absorption + layer.scattering)) {
        refuse_argument(name + "scattering", to_text(layer.scattering),
                        "a number whose sum with absorption is finite");
    }
    if (!(std::abs(layer.anisotropy) < 1)) {
        refuse_argument(name + "anisotropy", to_text(layer.anisotropy), "above -1 and below 1");
    }
    const double thickness = layer.thickness;
    if (std::isnan(thickness) || thickness < 0) {
        refuse_argument(name + "thickness", to_text(thickness), "0 mm or more");
    }
    if (std::isinf(thickness) && i + 1 < layers.size()) {
        refuse_argument(name + "thickness", to_text(thickness), "infinity in the last layer alone");
    }
    if (std::isinf(thickness) && layer.absorption + layer.scattering <= 0) {
        refuse_argument(name + "thickness", to_text(thickness),
                        "infinity only in a layer that absorbs or scatters");
    }
}

}  // namespace

void check_arguments(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                     int streams) {
    if (layers.empty()) refuse_argument("layers", "empty", "one layer or more");
    for (std::size_t i = 0; i < layers.size(); ++i) check_layer(layers, i);
    check_index("n_above", n_above);
    check_index("n_below", n_below);
    if (incidence.kind == Incidence::Kind::oblique && !(incidence.mu0 > 0 && incidence.mu0 <= 1)) {
        refuse_argument("incidence", to_text(incidence.mu0),
                        R"("normal", "diffuse" or a cosine above 0, at most 1)");
    }
    if (streams < least_streams || streams > most_streams || streams % 2 != 0) {
        refuse_argument(
            "streams", std::to_string(streams),
            "an even number from " + std::to_string(least_streams) + " to " + std::to_string(most_streams));
    }
}

}  // namespace skinglow::slab
