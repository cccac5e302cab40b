#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <map>
#include <string>

#include "numerics/detail.h"

/// Writing images: what the writers of this folder share. Not for use outside of it.
namespace skinglow::detail {

/// The bytes of an image file.
/// @param path  its extension says the format
/// @param spec  size, channels and the type of the pixels
/// @param text  goes into the header
/// @param pixels  rows from the top
/// @throws FileError naming the file
std::string image_bytes(const std::filesystem::path& path, OIIO::ImageSpec spec,
                        const std::map<std::string, std::string>& text, const void* pixels);

}  // namespace skinglow::detail
