#pragma once

#include <filesystem>

#include "files/lut_file.h"
#include "numerics/detail.h"

namespace skinglow::detail {

/// Writes the table as a strip that people can look at: 8-bit sRGB PNG, thickness from left (0 mm) to right,
/// colors between entries interpolated linearly in linear light, as hosts do. Colors above 1 are clamped.
/// @param width, height  pixels, 1 to 16384, else std::invalid_argument
/// @return texels of the table that were clamped. Throws FileError where the file is not .png or cannot be
/// written.
LutWriteReport write_lut_preview(const std::filesystem::path& path, const LutTable& table, int width = 512,
                                 int height = 64);

}  // namespace skinglow::detail
