#include <skinglow/box.h>

#include <glm/common.hpp>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow {

double Box::radius() const {
    return detail::length(half_extent());
}

double Box::min_distance(const glm::dvec3& point) const {
    return detail::length(glm::max(glm::max(min - point, point - max), glm::dvec3(0.0)));
}

double Box::max_distance(const glm::dvec3& point) const {
    return detail::length(glm::max(glm::abs(min - point), glm::abs(max - point)));
}

void validate(const Box& box) {
    require_finite("box min", box.min);
    require_finite("box max", box.max);
    for (int i = 0; i < 3; ++i) {
        if (box.min[i] > box.max[i])
            refuse_argument("box min", to_text(box.min), "at most " + to_text(box.max));
    }
}

Box box_of(std::span<const glm::dvec3> points) {
    if (points.empty()) refuse_argument("number of points", "0", "at least 1");
    Box box{points[0], points[0]};
    for (const glm::dvec3& point : points) {
        box.min = glm::min(box.min, point);
        box.max = glm::max(box.max, point);
    }
    validate(box);
    return box;
}

}  // namespace skinglow
