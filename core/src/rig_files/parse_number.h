#pragma once

#include <optional>
#include <string_view>

namespace skinglow {

/// The finite number that the whole of `text` spells; none otherwise.
std::optional<double> parse_number(std::string_view text);

}  // namespace skinglow
