#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "numerics/detail.h"

/// Opening images: what the readers of this folder share. Not for use outside of it.
namespace skinglow::detail {

/// An image file open for reading, its size checked.
class ImageInput {
  public:
    /// Throws FileError where the file is no image.
    explicit ImageInput(const std::filesystem::path& path);

    const OIIO::ImageSpec& spec() const { return input_->spec(); }
    const std::filesystem::path& path() const { return path_; }
    /// Name of the file's format, as OpenImageIO calls it.
    std::string format() const { return input_->format_name(); }
    /// Turns to another part of the file; false where there is none.
    bool go_to_part(int part);
    /// @throws FileError where the current part is too large or no flat image
    void check_size() const;
    /// Channels begin to end - 1 of the current part, interleaved, rows from the top.
    /// Throws FileError where the file ends too early or is damaged, or a value is not finite.
    std::vector<float> read_channels(int begin, int end);
    /// The current part's header texts whose key begins with "skinglow:".
    std::map<std::string, std::string> text() const;

  private:
    std::filesystem::path path_;
    std::unique_ptr<OIIO::ImageInput> input_;
    int part_ = 0;
};

}  // namespace skinglow::detail
