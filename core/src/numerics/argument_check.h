#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
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
std::string to_text(std::integral auto value) {
    return std::to_string(value);
}

/// Refuses an array of another length: "name is 3 entries; allowed: 4, one per vertex".
void require_count(std::string_view name, std::size_t count, std::size_t wanted, std::string_view of_what);

/// What an argument is called: text, or a function that returns it. A name that has to be put together is
/// given as a function, which is called only once the argument is refused: checks stand in inner loops.
template <typename Name>
concept ArgumentName = std::convertible_to<Name, std::string_view> || std::invocable<Name>;

/// The name of entry i of an array, "name[i]".
inline auto entry_name(std::string_view name, std::size_t i) {
    return [=] { return std::string(name) + "[" + std::to_string(i) + "]"; };
}

template <ArgumentName Name, typename Value>
[[noreturn]] void refuse_value(const Name& name, const Value& value, std::string_view allowed) {
    if constexpr (std::invocable<Name>) {
        refuse_argument(name(), to_text(value), allowed);
    } else {
        refuse_argument(name, to_text(value), allowed);
    }
}

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Each throws std::invalid_argument that names the argument, its value and what is allowed; else returns the
/// value.
template <ArgumentName Name, typename Value>
Value require(const Name& name, const Value& value, bool is_allowed, std::string_view allowed) {
    if (!is_allowed) refuse_value(name, value, allowed);
    return value;
}
template <ArgumentName Name>
double require_finite(const Name& name, double value) {
    return require(name, value, std::isfinite(value), "a finite number");
}
template <ArgumentName Name>
double require_not_negative(const Name& name, double value) {
    return require(name, value, std::isfinite(value) && value >= 0, "a finite number, 0 or more");
}
template <ArgumentName Name>
double require_positive(const Name& name, double value) {
    return require(name, value, std::isfinite(value) && value > 0, "a finite number above 0");
}
/// @param unit  what follows the range in the message, such as " mm"
template <ArgumentName Name, typename Value, typename Bound>
Value require_between(const Name& name, Value value, Bound min, Bound max, std::string_view unit = "") {
    if (!(value >= min && value <= max))
        refuse_value(name, value, to_text(min) + " to " + to_text(max) + std::string(unit));
    return value;
}
template <ArgumentName Name>
glm::dvec3 require_finite(const Name& name, const glm::dvec3& value) {
    return require(name, value, is_finite(value), "three finite numbers");
}
template <ArgumentName Name>
glm::dvec3 require_not_negative(const Name& name, const glm::dvec3& value) {
    return require(name, value, is_finite(value) && value.x >= 0 && value.y >= 0 && value.z >= 0,
                   "three finite numbers, 0 or more");
}

}  // namespace skinglow::detail
