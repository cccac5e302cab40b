#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A file that cannot be used. Its text is one line a person can act on: "file PATH: [WHERE: ]WHAT: REMEDY".
class FileError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Always throws FileError.
/// @param what    what is wrong with the file, with the value
/// @param remedy  what to do about it
/// @param where   the position in it, such as "key lights[2].color (line 14)"; empty: the file as a whole
[[noreturn]] void refuse_file(const std::filesystem::path& path, std::string_view what,
                              std::string_view remedy, std::string_view where = {});

/// The text of errno's value, as the system words it ("Permission denied").
std::string system_error_text(int error_number);

/// The extension in small letters with its dot (".exr"); empty without one.
std::string small_extension(const std::filesystem::path& path);

/// The whole file as bytes. Throws FileError where it cannot be read or is longer than allowed.
std::string read_whole_file(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace skinglow::detail
