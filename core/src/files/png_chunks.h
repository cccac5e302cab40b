#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A PNG's chunks, one after the other, skipping what they hold. Empty for a file that is no PNG.
class PngChunks {
  public:
    explicit PngChunks(const std::filesystem::path& path);

    bool is_png() const { return is_png_; }
    /// Name of the next chunk; none at the file's end, or where the file ends before the chunk does.
    std::optional<std::string> next();
    /// What the current chunk starts with, at most that many bytes.
    std::string data(std::size_t most);

  private:
    std::ifstream file_;
    std::uintmax_t end_ = 0;    ///< bytes of the file
    std::uintmax_t next_ = 0;   ///< where the next chunk begins
    std::uintmax_t data_ = 0;   ///< where the current chunk's data begin
    std::uint32_t length_ = 0;  ///< of the current chunk's data
    bool is_png_ = false;
};

/// Refuses a PNG that ends before its last chunk: libpng would jump out of OpenImageIO 2.4's reading callback, which then
/// never frees the text of its error. Other formats pass. @throws FileError
void check_png_is_whole(const std::filesystem::path& path);

}  // namespace skinglow::detail
