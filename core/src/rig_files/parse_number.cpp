#include "rig_files/parse_number.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>

namespace skinglow::detail {

std::optional<double> parse_number(std::string_view text) {
    const auto value = take_number(text);
    return text.empty() ? value : std::nullopt;
}

// std::from_chars does the same, but libc++ has it for double only from 20 on, and leaves out what is too small.
std::optional<double> take_number(std::string_view& text) {
    std::string_view digits = text;
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    double value = 0.0;
    const auto result = fast_float::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (result.ptr == digits.data() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return value;
}

std::string_view take_until(std::string_view& rest, char separator) {
    const std::size_t length = std::min(rest.find(separator), rest.size());
    const std::string_view part = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    return part;
}

}  // namespace skinglow::detail
