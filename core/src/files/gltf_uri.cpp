#include "files/gltf_uri.h"

#include <cstddef>
#include <cstdint>

namespace skinglow::detail {

bool decode_base64(std::string_view text, std::string& bytes) {
    while (text.ends_with('=')) text.remove_suffix(1);
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char letter : text) {
        std::uint32_t digit = 0;
        if (letter >= 'A' && letter <= 'Z') {
            digit = static_cast<std::uint32_t>(letter - 'A');
        } else if (letter >= 'a' && letter <= 'z') {
            digit = static_cast<std::uint32_t>(letter - 'a') + 26;
        } else if (letter >= '0' && letter <= '9') {
            digit = static_cast<std::uint32_t>(letter - '0') + 52;
        } else if (letter == '+' || letter == '-') {
            digit = 62;
        } else if (letter == '/' || letter == '_') {
            digit = 63;
        } else {
            return false;
        }
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
