#include <skinglow/slab.h>

#include <cmath>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "slab/stream_grid.h"
#include "slab/variable_layer.h"

namespace skinglow {

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
