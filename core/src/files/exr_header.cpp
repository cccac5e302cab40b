#include "files/exr_header.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "files/number_bytes.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

constexpr std::uint32_t magic = 0x01312F76;
constexpr std::uint32_t has_parts = 0x1000;  // a flag beside the version
constexpr std::size_t longest_name = 255;
constexpr std::size_t word = 4;
constexpr const char* damaged_remedy = "the file is damaged or was not written to its end; make it anew";

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

/// Bytes of each type that has a fixed number: OpenEXR reads as many, whatever the header says.
const std::map<std::string, std::uint32_t> fixed_sizes = {{"box2i", 16},
                                                          {"box2f", 16},
                                                          {"chromaticities", 32},
                                                          {"compression", 1},
                                                          {"deepImageState", 1},
                                                          {"double", 8},
                                                          {"envmap", 1},
                                                          {"float", 4},
                                                          {"int", 4},
                                                          {"keycode", 28},
                                                          {"lineOrder", 1},
                                                          {"m33f", 36},
                                                          {"m33d", 72},
                                                          {"m44f", 64},
                                                          {"m44d", 128},
                                                          {"rational", 8},
                                                          {"tiledesc", 9},
                                                          {"timecode", 8},
                                                          {"v2i", 8},
                                                          {"v2f", 8},
                                                          {"v2d", 16},
                                                          {"v3i", 12},
                                                          {"v3f", 12},
                                                          {"v3d", 24}};

/// Where channels end by their own names: each has a name, the byte 0 and 16 bytes; an empty name comes last.
bool are_channels(std::string_view data) {
    constexpr std::size_t of_channel = 16;
    while (!data.empty() && data.front() != 0) {
        const std::size_t end = data.find(char{0});
        if (end == std::string_view::npos || end + 1 + of_channel > data.size()) return false;
        data.remove_prefix(end + 1 + of_channel);
    }
    return data.size() == 1;
}

/// Whether texts, each after its length, fill the data.
bool are_texts(std::string_view data) {
    while (data.size() >= word) {
        const std::uint64_t length = word_at(data, 0);
        if (length > data.size() - word) return false;
        data.remove_prefix(word + length);
    }
    return data.empty();
}

/// A small picture: width, height and four bytes a pixel.
bool is_preview(std::string_view data) {
    if (data.size() < 2 * word) return false;
    const std::uint64_t pixels = std::uint64_t{word_at(data, 0)} * word_at(data, word);  // below 2^64
    return pixels <= data.size() && data.size() == 2 * word + 4 * pixels;
}

/// Whether OpenEXR reads as many bytes as the header says.
bool is_as_long_as_it_says(const std::string& type, std::string_view data) {
    if (const auto fixed = fixed_sizes.find(type); fixed != fixed_sizes.end())
        return data.size() == fixed->second;
    if (type == "chlist") return are_channels(data);
    if (type == "stringvector") return are_texts(data);
    if (type == "preview") return is_preview(data);
    return true;
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
            refuse_file(path, "is longer than the file", damaged_remedy, "attribute " + *name);
        }
        std::string data(*length, '\0');
        file.read(data.data(), static_cast<std::streamsize>(data.size()));
        if (!is_as_long_as_it_says(*type, data)) {
            refuse_file(path, "is of " + std::to_string(*length) + " bytes, which is not what its type has",
                        damaged_remedy, "attribute " + *name);
        }
    }
}

}  // namespace skinglow::detail
