#include "cli/output_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iostream>
#include <string_view>
#include <utility>

namespace skinglow::cli {
namespace {

/// Characters, not bytes: names of lights come in every script.
std::size_t shown_width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
    }));
}

/// One line of a table: what a name's line ends and other control characters would do to it, a terminal does.
std::string shown(std::string text) {
    for (char& byte : text) {
        if (static_cast<unsigned char>(byte) < ' ' || byte == '\x7f') byte = '?';
    }
    return text;
}

}  // namespace

std::string short_number(double value) {
    std::array<char, 32> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6);
    return {buffer.data(), end.ptr};
}

void print_table(std::ostream& out, std::vector<std::vector<std::string>> rows) {
    for (auto& row : rows) {
        for (std::string& cell : row) cell = shown(std::move(cell));
    }
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown_width(row[i]));
    }
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space(widths[i] - shown_width(row[i]), ' ');
            if (i > 0) line += "  ";
            line += i < 2 ? row[i] + space : space + row[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
    }
}

std::string shell_word(const std::string& path) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%";
    if (!path.empty() && path.find_first_not_of(plain) == std::string::npos) return path;
    std::string word = "'";
    for (const char byte : path) word += byte == '\'' ? std::string("'\\''") : std::string(1, byte);
    return word + "'";
}

void tell(const std::string& path, const std::string& note) {
    std::cerr << "skinglow: file " << path << ": note: " << note << '\n';
}

nlohmann::ordered_json to_json(const glm::dvec3& value) {
    return nlohmann::ordered_json::array({value.x, value.y, value.z});
}

void print_json(const nlohmann::ordered_json& value) {
    std::cout << value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace skinglow::cli
