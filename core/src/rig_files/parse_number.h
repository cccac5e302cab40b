#pragma once

#include <optional>
#include <string_view>

#include "numerics/detail.h"

/// The one place where numbers are parsed, in any locale and with every digit.
namespace skinglow::detail {

/// The finite number that the whole of `text` spells; none otherwise. What is too small for a double is 0.
std::optional<double> parse_number(std::string_view text);

/// The finite number that `text` starts with, after a sign or none; it is taken off. None, and `text` as it
/// was, where there is none.
std::optional<double> take_number(std::string_view& text);

/// Cuts a text at its first separator.
/// @param rest  becomes what follows the separator; empty where there is none
/// @return the part before it
std::string_view take_until(std::string_view& rest, char separator);

}  // namespace skinglow::detail
