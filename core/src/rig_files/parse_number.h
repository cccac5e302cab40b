#pragma once

#include <optional>
#include <string_view>

#include "numerics/detail.h"

namespace skinglow::detail {

/// The finite number that the whole of `text` spells; none otherwise.
std::optional<double> parse_number(std::string_view text);

}  // namespace skinglow::detail
