#pragma once

#include <glm/vec3.hpp>
#include <span>

/// Bounding boxes.
/// @code
/// const skinglow::Box box = skinglow::box_of(vertices);
/// const double half_diagonal = box.radius();
/// @endcode
namespace skinglow {

/// An axis-aligned bounding box, in the unit of its points.
struct Box {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};

    /// Midpoint of the two corners; no overflow for any finite box.
    glm::dvec3 center() const { return 0.5 * min + 0.5 * max; }
    /// Half the extent along each axis.
    glm::dvec3 half_extent() const { return 0.5 * max - 0.5 * min; }
    /// Radius of the bounding sphere about the center: half the diagonal.
    double radius() const;
    /// Distance from a point to the nearest point of the box; 0 within it.
    double min_distance(const glm::dvec3& point) const;
    /// Distance from a point to the farthest point of the box.
    double max_distance(const glm::dvec3& point) const;
};

/// @throws std::invalid_argument where a corner is not finite or `min` is above `max` along an axis
void validate(const Box& box);

/// The smallest box around the points.
/// @param points  one or more, finite, else std::invalid_argument
Box box_of(std::span<const glm::dvec3> points);

}  // namespace skinglow
