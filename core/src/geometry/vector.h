#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Length that neither over- nor underflows in between; inf only where it is itself beyond the largest
/// double.
double length(const glm::dvec3& v);

/// Unit vector of any finite vector but 0, also where its square would over- or underflow.
glm::dvec3 unit(const glm::dvec3& v);

/// Angle between two vectors of any length, radians, 0 to pi. By atan2: exact near 0 and pi, where acos of a
/// dot product is not.
double angle_between(const glm::dvec3& a, const glm::dvec3& b);

/// Largest component by magnitude.
double max_abs(const glm::dvec3& v);

/// Unit normal of a triangle whose corners run counter-clockwise seen from the side it points to; (0, 0, 0)
/// where the triangle's area is no more than rounding, so that it has no normal and stops no light. For any
/// finite corners less than the largest double apart.
glm::dvec3 triangle_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// Whether no entry of M^T M - 1 is as large as the tolerance; not where one is NaN.
bool is_orthogonal(const glm::dmat3& matrix, double tolerance);

/// Right-handed orthonormal frame, as columns x, y, z, whose z is the unit vector given. It takes directions
/// about +z to that axis.
glm::dmat3 frame_around(const glm::dvec3& unit_axis);

/// The same for a direction of any length but 0, with x along the tangent as far as it is perpendicular to
/// the direction. A tangent parallel to it, or 0, leaves x arbitrary.
glm::dmat3 frame_around(const glm::dvec3& direction, const glm::dvec3& tangent);

}  // namespace skinglow::detail
