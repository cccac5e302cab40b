#include "geometry/rigid_motion.h"

#include <string>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow::detail {

RigidMotion::RigidMotion(std::string_view name, const glm::dmat4& matrix)
    : rotation_(matrix), translation_(matrix[3]) {
    constexpr double tolerance = 1e-5;  // of a host's single precision
    const glm::dvec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (is_orthogonal(rotation_, tolerance) && is_finite(translation_) &&
        last == glm::dvec4(0.0, 0.0, 0.0, 1.0))
        return;
    std::string text;
    for (int row = 0; row < 4; ++row) {
        text += row == 0 ? "(" : "; ";
        for (int column = 0; column < 4; ++column)
            text += (column == 0 ? "" : ", ") + to_text(matrix[column][row]);
    }
    refuse_argument(name, text + ")", "a rotation and a translation, as a finite 4 x 4 matrix");
}

}  // namespace skinglow::detail
