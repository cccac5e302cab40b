#include "numerics/argument_check.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace skinglow::detail {

void refuse_argument(std::string_view name, const std::string& value, std::string_view allowed) {
    std::string message(name);
    message += " is ";
    message += value;
    message += "; allowed: ";
    message += allowed;
    throw std::invalid_argument(message);
}

std::string to_text(double value) {
    std::array<char, 32> buffer{};
    const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), written.ptr};
}

std::string to_text(const glm::dvec3& value) {
    return "(" + to_text(value.x) + ", " + to_text(value.y) + ", " + to_text(value.z) + ")";
}

double require_finite(std::string_view name, double value) {
    if (!std::isfinite(value)) refuse_argument(name, to_text(value), "a finite number");
    return value;
}

double require_not_negative(std::string_view name, double value) {
    if (!std::isfinite(value) || value < 0)
        refuse_argument(name, to_text(value), "a finite number, 0 or more");
    return value;
}

double require_positive(std::string_view name, double value) {
    if (!std::isfinite(value) || value <= 0) refuse_argument(name, to_text(value), "a finite number above 0");
    return value;
}

glm::dvec3 require_finite(std::string_view name, const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(value[i])) refuse_argument(name, to_text(value), "three finite numbers");
    }
    return value;
}

glm::dvec3 require_not_negative(std::string_view name, const glm::dvec3& value) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(value[i]) || value[i] < 0) {
            refuse_argument(name, to_text(value), "three finite numbers, 0 or more");
        }
    }
    return value;
}

}  // namespace skinglow::detail
