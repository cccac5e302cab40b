#include "rig_files/file_error.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace skinglow::detail {

void refuse_file(const std::filesystem::path& path, std::string_view what, std::string_view remedy,
                 std::string_view where) {
    std::string message = "file " + path.string() + ": ";
    if (!where.empty()) {
        message += where;
        message += ": ";
    }
    message += what;
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
    std::string text;
    text.reserve(std::min<std::uintmax_t>(std::filesystem::file_size(path, ignored), max_bytes));
    std::string block(std::size_t{1} << 16U, '\0');
    while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
        text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
        if (text.size() > max_bytes) {
            refuse_file(path, "is longer than " + std::to_string(max_bytes) + " bytes",
                        "is it the right file? Split it if it is");
        }
    }
    if (stream.bad()) refuse_file(path, "cannot be read: " + system_error_text(errno), "check the disk");
    return text;
}

}  // namespace skinglow::detail
