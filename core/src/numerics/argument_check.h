#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Refuses a bad argument with one sentence that a person can act on: "name is value; allowed: ...".
/// Always throws std::invalid_argument (ValueError in Python).
[[noreturn]] void refuse_argument(std::string_view name, const std::string& value, std::string_view allowed);

/// The shortest text that reads back as the same double; "nan" and "inf" for those.
std::string to_text(double value);
std::string to_text(const glm::dvec3& value);

/// Each throws std::invalid_argument that names the argument, its value and what is allowed; else returns the
/// value.
double require_finite(std::string_view name, double value);
double require_not_negative(std::string_view name, double value);
double require_positive(std::string_view name, double value);
glm::dvec3 require_finite(std::string_view name, const glm::dvec3& value);
glm::dvec3 require_not_negative(std::string_view name, const glm::dvec3& value);

}  // namespace skinglow::detail
