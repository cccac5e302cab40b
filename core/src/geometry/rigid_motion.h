#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A rotation, with or without a reflection, and then a translation.
class RigidMotion {
  public:
    RigidMotion() = default;
    /// @param name    of the matrix, for messages
    /// @param matrix  on column vectors: orthogonal to 1e-5, then the translation, with 0, 0, 0, 1 as its last row; else
    ///                std::invalid_argument
    RigidMotion(std::string_view name, const glm::dmat4& matrix);

    glm::dvec3 point(const glm::dvec3& p) const { return rotation_ * p + translation_; }
    glm::dvec3 direction(const glm::dvec3& d) const { return rotation_ * d; }

  private:
    glm::dmat3 rotation_{1.0};
    glm::dvec3 translation_{0.0};
};

}  // namespace skinglow::detail
