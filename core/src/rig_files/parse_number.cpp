#include "rig_files/parse_number.h"

#include <fast_float/fast_float.h>

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

}  // namespace skinglow::detail
