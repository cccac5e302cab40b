#include "povray/sdl_text.h"

#include <cstdint>

#include "numerics/argument_check.h"

namespace skinglow::detail {
namespace {

constexpr std::string_view hexadecimal = "0123456789ABCDEF";

// Not by <cctype>: whether a letter is one must not depend on the locale of the host.
bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

void SdlText::append(double value) {
    // + 0: minus zero becomes zero, so that files of equal scenes are equal.
    text_ += to_text(require_finite("number in the POV-Ray scene", value) + 0.0);
}

std::string sdl_identifier(std::string_view kind, std::string_view name) {
    std::string identifier = "Skinglow_";
    identifier += kind;
    identifier += '_';
    for (const char c : name) {
        if (is_letter_or_digit(c)) {
            identifier += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            identifier += {'_', hexadecimal[byte >> 4U], hexadecimal[byte & 15U], '_'};
        }
    }
    // POV-Ray ends at "String too long" somewhere above: a sum over the rest keeps long names apart.
    constexpr std::size_t max_length = 120;
    if (identifier.size() > max_length) {
        std::uint64_t sum = 0;
        for (const char c : identifier) sum = sum * 1099511628211ULL + static_cast<unsigned char>(c);
        identifier.resize(max_length);
        identifier += '_';
        identifier += std::to_string(sum);
    }
    return identifier;
}

std::string sdl_string(std::string_view field, std::string_view text) {
    std::string literal = "\"";
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
            refuse_argument(field, "\"" + sdl_comment(text) + "\"", "text without control characters");
        }
        if (c == '"' || c == '\\') literal += '\\';
        literal += c;
    }
    return literal + '"';
}

std::string sdl_comment(std::string_view text) {
    std::string comment;
    for (const char c : text) comment += c >= ' ' && c <= '~' && c != '\\' ? c : '?';
    return comment;
}

}  // namespace skinglow::detail
