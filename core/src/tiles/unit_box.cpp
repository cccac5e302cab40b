#include "tiles/unit_box.h"

#include <cmath>
#include <glm/common.hpp>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow::detail {

// With halves throughout, because the sum or difference of two huge coordinates may overflow where theirs does not.
UnitBox::UnitBox(const Box& box)
    : half_center_(0.25 * box.min + 0.25 * box.max), scale_(2 * max_abs(0.5 * box.max - 0.5 * box.min)) {
    if (!std::isfinite(scale_)) {
        refuse_argument("vertices", "from " + to_text(box.min) + " to " + to_text(box.max),
                        "an extent below the largest double");
    }
    if (scale_ == 0) scale_ = 1;
}

glm::dvec3 UnitBox::operator()(const glm::dvec3& point) const {
    return glm::clamp((0.5 * point - half_center_) / (0.5 * scale_), -1.0, 1.0);
}

}  // namespace skinglow::detail
