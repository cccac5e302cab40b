#pragma once

#include <string>
#include <string_view>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Bytes of base64 (RFC 4648), padded or not. False where there is something else in it.
bool decode_base64(std::string_view text, std::string& bytes);
/// Bytes of a percent-encoded URI (RFC 3986). False where a % has no two digits.
bool decode_percent(std::string_view text, std::string& bytes);

}  // namespace skinglow::detail
