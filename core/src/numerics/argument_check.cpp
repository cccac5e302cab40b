#include "numerics/argument_check.h"

#include <array>
#include <charconv>
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

void require_count(std::string_view name, std::size_t count, std::size_t wanted, std::string_view of_what) {
    if (count != wanted)
        refuse_argument(name, to_text(count) + " entries", to_text(wanted) + ", " + std::string(of_what));
}

}  // namespace skinglow::detail
