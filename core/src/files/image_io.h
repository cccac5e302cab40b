#pragma once

#include <OpenImageIO/imageio.h>

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "numerics/detail.h"

/// Images through OpenImageIO: what the readers and writers of this folder share. Not for use outside of it.
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

/// Where an image has its color: a part and channels in it; all three alike for gray.
struct ColorChannels {
    int part = 0;
    std::array<int, 3> rgb{};
    std::optional<int> alpha;
    std::vector<std::string> others;  ///< names of further layers of color, which are left aside
};

/// Finds the color among all parts and layers: the only one, the one named Combined (Blender's multilayer
/// EXR), or the one whose channels are plainly R, G and B; else a channel alone as gray, with alpha or
/// without.
/// @throws FileError where there is none or several could be meant, naming them
ColorChannels find_color(ImageInput& input);

/// Index of a channel in a part.
std::optional<int> find_channel(const OIIO::ImageSpec& spec, std::string_view name);

/// The bytes of an image file.
/// @param path  its extension says the format
/// @param spec  size, channels and the type of the pixels
/// @param text  goes into the header
/// @param pixels  rows from the top
/// @throws FileError naming the file
std::string image_bytes(const std::filesystem::path& path, OIIO::ImageSpec spec,
                        const std::map<std::string, std::string>& text, const void* pixels);

}  // namespace skinglow::detail
