#include <skinglow/lut.h>

#include <string>

#include "numerics/argument_check.h"

namespace skinglow {

std::vector<glm::dvec3> recolor(const BaseLut& base, const glm::dvec3& weight) {
    std::vector<glm::dvec3> colors(base.size());
    recolor(base, weight, colors);
    return colors;
}

void recolor(const BaseLut& base, const glm::dvec3& weight, std::span<glm::dvec3> out) {
    require_finite("weight", weight);
    require_count("output", out.size(), base.size(), "the base's");
    const std::span<const glm::dmat3> matrices = base.matrices();
    // 0 * value is 0 for every finite value and NaN for the others: one sum checks the table without a branch
    // a texel.
    glm::dvec3 overflow(0.0);
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        out[i] = matrices[i] * weight;
        overflow += 0.0 * out[i];
    }
    if (overflow != glm::dvec3(0.0)) {
        refuse_argument("weight", to_text(weight), "one whose product with the base lookup stays finite");
    }
}

}  // namespace skinglow
