#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace skinglow {

/// Writes a file whole or not at all: `write` fills a temporary file in the same folder, which is then
/// flushed to the disk (fsync) and renamed to `path`. When anything fails, what stood at `path` before stands
/// there still and the temporary file is gone. Links are followed. May be called from many threads at once.
/// @param path   no device or folder: renaming over /dev/stdout would replace the device
/// @param write  gets the temporary file's name, which has the extension of `path`; reports failure by
///               throwing
/// @throws FileError where the folder is missing or cannot be written, or where `path` is no regular file;
///         and whatever `write` throws
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes at hand.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace skinglow
