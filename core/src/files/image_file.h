#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Widest and highest image that is read, and most pixels; beyond it an image is refused before memory is
/// taken.
constexpr int max_image_side = 65536;
constexpr std::int64_t max_image_pixels = std::int64_t{1} << 26;

/// An image as linear light.
struct LinearImage {
    int width = 0;
    int height = 0;
    bool gray = false;  ///< one color channel in the file; `rgb` repeats it
    std::vector<float>
        rgb;  ///< (height, width, 3), rows from the top, linear Rec.709, multiplied by alpha, finite
    std::vector<float> alpha;                 ///< (height, width) coverage; empty where the file has none
    std::map<std::string, std::string> text;  ///< text in the file's header whose key begins with "skinglow:"
    std::vector<std::string> notes;           ///< what reading decided, for people: "... decoded from sRGB"

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Reads an image of any format that OpenImageIO knows.
/// - Color: the only layer of color of all parts, the one named Combined (Blender's multilayer EXR), or the
///   one whose channels are R, G and B without a prefix; else one channel as gray. Where several layers could
///   be meant the image is refused; layers left aside are named in the notes.
/// - Encoding: what the file says of itself (in a PNG cICP, sRGB, gAMA; chromaticities of cHRM and EXR are
///   converted to Rec.709); a file that says nothing is linear if it holds floats, sRGB if integers. What it
///   says and is not read (ICC profiles) is named in the notes.
/// - A data window smaller than the picture (a cropped EXR) is placed where it belongs; outside it is black and
/// uncovered. Throws FileError where the file is unreadable, truncated, too large or holds a pixel that is
/// not finite.
LinearImage read_image(const std::filesystem::path& path);

/// Channels of an image as they stand in the file, not decoded, each (height, width); for tables that are stored as
/// images.
struct RawChannels {
    int width = 0;
    int height = 0;
    std::vector<std::vector<float>> channels;
    std::map<std::string, std::string> text;  ///< as in LinearImage
};
/// The named channels of the image's first part; none where it has not every one of them.
/// @throws FileError as read_image
std::optional<RawChannels> read_raw_channels(const std::filesystem::path& path,
                                             const std::vector<std::string>& names);

}  // namespace skinglow::detail
