#include <array>
#include <cstddef>
#include <cstdint>

#include "files/gltf_document.h"

namespace skinglow::detail {

namespace {

constexpr std::uint8_t no_digit = 64;

/// The value of each letter in base64; - and _ are + and / in URIs.
constexpr std::array<std::uint8_t, 256> base64_digits = [] {
    std::array<std::uint8_t, 256> values{};
    values.fill(no_digit);
    std::uint8_t value = 0;
    for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
        values[static_cast<unsigned char>(c)] = value++;
    values['-'] = values['+'];
    values['_'] = values['/'];
    return values;
}();

}  // namespace

bool decode_base64(std::string_view text, std::string& bytes) {
    while (text.ends_with('=')) text.remove_suffix(1);
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char letter : text) {
        const std::uint32_t digit = base64_digits[static_cast<unsigned char>(letter)];
        if (digit == no_digit) return false;
        bits = (bits << 6U | digit) & 0xFFFFFFU;
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU);
        }
    }
    return true;
}

bool decode_percent(std::string_view text, std::string& bytes) {
    bytes.clear();
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            bytes += text[i];
            continue;
        }
        constexpr std::string_view digits = "0123456789abcdef";
        if (i + 2 >= text.size()) return false;
        const std::size_t high = digits.find(static_cast<char>(text[i + 1] | 0x20));
        const std::size_t low = digits.find(static_cast<char>(text[i + 2] | 0x20));
        if (high == std::string_view::npos || low == std::string_view::npos) return false;
        bytes += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return true;
}

}  // namespace skinglow::detail
