#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace skinglow {

/// Writes a file whole or not at all: `write` fills a temporary file in the same folder, which is then
/// flushed to the disk (fsync) and renamed to `path`. When anything fails, what stood at `path` before stands
/// there still and the temporary file is gone.
/// @param write  gets the temporary file's name, which has the extension of `path`; reports failure by
/// throwing Throws FileError where the folder is missing or cannot be written, or where `path` is no regular
/// file (renaming over /dev/stdout would replace the device); and whatever `write` throws. Links are
/// followed.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes at hand.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace skinglow
