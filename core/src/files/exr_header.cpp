#include "files/exr_header.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "files/number_bytes.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

constexpr std::uint32_t magic = 0x01312F76;
constexpr std::uint32_t has_parts = 0x1000;  // a flag beside the version
constexpr std::size_t longest_name = 255;

std::optional<std::uint32_t> read_word(std::istream& file) {
    std::array<char, 4> bytes{};
    if (!file.read(bytes.data(), bytes.size())) return std::nullopt;
    return raw_number<std::uint32_t, false>(bytes.data());
}

/// Text up to the byte 0 that ends it; none where that does not come.
std::optional<std::string> read_name(std::istream& file) {
    std::string name;
    for (char letter = 0; name.size() <= longest_name && file.get(letter); name += letter) {
        if (letter == 0) return name;
    }
    return std::nullopt;
}

}  // namespace

void check_exr_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || read_word(file) != magic) return;
    const auto version = read_word(file);
    if (!version) return;
    // Of several parts each has a header, and an empty one comes last.
    bool is_first = true;
    for (auto name = read_name(file); name; name = read_name(file)) {
        if (name->empty()) {
            if ((*version & has_parts) == 0 || is_first) return;
            is_first = true;
            continue;
        }
        is_first = false;
        const auto type = read_name(file);
        const auto length = type ? read_word(file) : std::nullopt;
        if (!length) return;
        const auto here = static_cast<std::uintmax_t>(file.tellg());
        if (*length > size - here) {
            refuse_file(path, "is longer than the file",
                        "the file is damaged or was not written to its end; make it anew",
                        "attribute " + *name);
        }
        file.seekg(static_cast<std::streamoff>(*length), std::ios::cur);
    }
}

}  // namespace skinglow::detail
