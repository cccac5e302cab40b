#include <cmath>
#include <string>

#include "numerics/argument_check.h"
#include "slab/stream_grid.h"

namespace skinglow::detail {
namespace {

void check_layer(std::span<const Layer> layers, std::size_t i) {
    const Layer& layer = layers[i];
    const auto field = [i](const char* name) {
        return [i, name] { return entry_name("layers", i)() + "." + name; };
    };
    require_between(field("refractive_index"), layer.refractive_index, 1.0, max_refractive_index);
    require_not_negative(field("absorption"), layer.absorption);
    require_not_negative(field("scattering"), layer.scattering);
    if (!std::isfinite(layer.absorption + layer.scattering)) {
        refuse_value(field("scattering"), layer.scattering, "a number whose sum with absorption is finite");
    }
    if (!(std::abs(layer.anisotropy) < 1)) {
        refuse_value(field("anisotropy"), layer.anisotropy, "above -1 and below 1");
    }
    const double thickness = layer.thickness;
    if (!(thickness >= 0)) refuse_value(field("thickness"), thickness, "0 mm or more");
    if (std::isinf(thickness) && i + 1 < layers.size()) {
        refuse_value(field("thickness"), thickness, "infinity in the last layer alone");
    }
    if (std::isinf(thickness) && layer.absorption + layer.scattering <= 0) {
        refuse_value(field("thickness"), thickness, "infinity only in a layer that absorbs or scatters");
    }
}

}  // namespace

void check_arguments(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                     int streams) {
    if (layers.empty()) refuse_argument("layers", "empty", "one layer or more");
    for (std::size_t i = 0; i < layers.size(); ++i) check_layer(layers, i);
    require_between("n_above", n_above, 1.0, max_refractive_index);
    require_between("n_below", n_below, 1.0, max_refractive_index);
    if (incidence.kind == Incidence::Kind::oblique && !(incidence.mu0 > 0 && incidence.mu0 <= 1)) {
        refuse_argument("incidence", to_text(incidence.mu0),
                        R"("normal", "diffuse" or a cosine above 0, at most 1)");
    }
    if (streams < min_streams || streams > max_streams || streams % 2 != 0) {
        refuse_argument(
            "streams", std::to_string(streams),
            "an even number from " + std::to_string(min_streams) + " to " + std::to_string(max_streams));
    }
}

double flux_fraction(const char* name, double value, int streams) {
    constexpr double rounding = 1e-11;
    if (!(value >= -rounding && value <= 1 + rounding)) {
        refuse_argument("streams", std::to_string(streams),
                        std::string("more for these layers and this incidence: ") + name +
                            " would come out as " + to_text(value));
    }
    return std::min(std::max(value, 0.0), 1.0);
}

}  // namespace skinglow::detail
