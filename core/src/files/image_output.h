#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <map>
#include <string>

#include "numerics/detail.h"

/// Writing images: what the writers of this folder share. Not for use outside of it.
namespace skinglow::detail {

/// Writes the pixels, rows from the top, of the type that `spec.format` says, whole or not at all.
/// `text` goes into the header. Throws FileError naming the file.
void write_image(const std::filesystem::path& path, OIIO::ImageSpec spec,
                 const std::map<std::string, std::string>& text, const void* pixels);

/// The bytes of such a file. @param path  its extension says the format
std::string image_bytes(const std::filesystem::path& path, OIIO::ImageSpec spec,
                        const std::map<std::string, std::string>& text, const void* pixels);

}  // namespace skinglow::detail
