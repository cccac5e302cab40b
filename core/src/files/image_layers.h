#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "files/image_input.h"
#include "numerics/detail.h"

namespace skinglow::detail {

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

}  // namespace skinglow::detail
