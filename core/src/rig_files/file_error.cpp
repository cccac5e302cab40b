#include "rig_files/file_error.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "numerics/huge_pages.h"

namespace skinglow::detail {

namespace {

/// Bytes of the UTF-8 character that the text starts with; 0 where it starts with none.
std::size_t character_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    const std::size_t length = lead < 0x80U       ? 1
                               : lead >> 5U == 6  ? 2
                               : lead >> 4U == 14 ? 3
                               : lead >> 3U == 30 ? 4
                                                  : 0;
    if (length > text.size() || lead == 0xC0U || lead == 0xC1U || lead > 0xF4U) return 0;
    for (const char next : text.substr(1, length - (length > 0 ? 1 : 0))) {
        if ((static_cast<unsigned char>(next) & 0xC0U) != 0x80U) return 0;
    }
    return length;
}

/// What a damaged file holds may be anything; a message is one line of text.
std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const auto first = static_cast<unsigned char>(text.front());
        if (length == 0 || first < 0x20U || first == 0x7FU) {
            result += '?';
        } else {
            result += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

}  // namespace

void refuse_file(const std::filesystem::path& path, std::string_view what, std::string_view remedy,
                 std::string_view where) {
    std::string message = "file " + path.string() + ": ";
    if (!where.empty()) {
        message += printable(where);
        message += ": ";
    }
    message += printable(what);
    message += ": ";
    message += remedy;
    throw FileError(message);
}

std::string system_error_text(int error_number) {
    return std::generic_category().message(error_number);
}

std::string small_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return extension;
}

std::string read_whole_file(const std::filesystem::path& path, std::size_t max_bytes) {
    std::error_code ignored;
    // A folder opens as a stream and fails only when read, with a text that helps nobody; a pipe waits for a writer.
    if (std::filesystem::is_directory(path, ignored))
        refuse_file(path, "is a folder", "give the name of a file");
    if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
        refuse_file(path, "is a pipe or a device", "give the name of a file");
    }
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        refuse_file(path, "cannot be read: " + system_error_text(errno),
                    "check the name and the permissions");
    // In one piece; what is written to it meanwhile, or has no size to begin with (/proc), comes in further ones.
    const auto size = std::filesystem::file_size(path, ignored);
    std::string text;
    for (std::size_t next = ignored ? 0 : std::min<std::uintmax_t>(size, max_bytes) + 1; stream;
         next = 1U << 16U) {
        const std::size_t before = text.size();
        reserve_huge(text, before + next);
        text.resize(before + next);
        stream.read(text.data() + before, static_cast<std::streamsize>(next));
        text.resize(before + static_cast<std::size_t>(stream.gcount()));
        if (text.size() > max_bytes) {
            refuse_file(path, "is longer than " + std::to_string(max_bytes) + " bytes",
                        "is it the right file? Split it if it is");
        }
    }
    if (stream.bad()) refuse_file(path, "cannot be read: " + system_error_text(errno), "check the disk");
    return text;
}

}  // namespace skinglow::detail
