#pragma once

#include <concepts>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Text in POV-Ray's scene description language. Numbers are the shortest that read back as the same double.
class SdlText {
  public:
    /// Appends text, whole numbers, doubles and vectors, <x,y> or <x,y,z>.
    /// @throws std::invalid_argument on inf and NaN, which SDL has not
    template <typename... Part>
    SdlText& add(const Part&... parts) {
        (append(parts), ...);
        return *this;
    }

    /// Entry i of a list: a comma before all but the first, and line ends that keep lines readable.
    template <typename... Part>
    void add_item(std::size_t i, std::size_t per_line, const Part&... parts) {
        add(i > 0 ? "," : "", i % per_line == 0 ? "\n" : " ", parts...);
    }

    void reserve(std::size_t characters) { text_.reserve(characters); }
    std::string take() { return std::move(text_); }

  private:
    void append(std::string_view text) { text_ += text; }
    void append(std::integral auto value) { text_ += std::to_string(value); }
    void append(double value);
    void append(const glm::dvec2& v) { add("<", v.x, ",", v.y, ">"); }
    void append(const glm::dvec3& v) { add("<", v.x, ",", v.y, ",", v.z, ">"); }

    std::string text_;
};

/// An identifier that POV-Ray cannot take for a word of its own: the prefix Skinglow_, then the name's
/// letters and digits, everything else by its bytes in hexadecimal (_C3_). Different names give different
/// identifiers.
std::string sdl_identifier(std::string_view kind, std::string_view name);

/// A string literal: quotes and backslashes escaped. Throws std::invalid_argument, naming the field, on
/// control characters, which SDL strings cannot hold.
std::string sdl_string(std::string_view field, std::string_view text);

/// What stands after //: printable ASCII, anything else as ?; a backslash at the end cannot continue the
/// line.
std::string sdl_comment(std::string_view text);

}  // namespace skinglow::detail
