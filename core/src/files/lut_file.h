#pragma once

#include <skinglow/light_weights.h>
#include <skinglow/lut.h>

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "files/color_encoding.h"

/// Lookup tables as files. A table is an image one texel high; entry i is texel i (LutAxis). What the pixels
/// do not say (the thickness axis in mm, how the table was made) is text in the header, keys "skinglow:...":
/// table ("recolored" or "base"), max_thickness_mm, mode, light_weight, blood_weight, coefficients,
/// encoding.
namespace skinglow::detail {

/// How a recolored table was made; what does not apply stays empty.
struct LutRecord {
    double max_thickness_mm = 0.0;
    std::optional<LutMode> mode = {};
    std::optional<glm::dvec3> light_weight = {};  ///< L of Eq. 3; in mode physical the irradiance E, W/m^2
    std::optional<glm::dvec3> blood_weight = {};  ///< B of Eq. 1
    std::optional<AttenuationCoefficients> coefficients = {};  ///< of Eq. 2
};

/// A recolored table: linear Rec.709, values above 1 kept.
struct LutTable {
    std::vector<glm::dvec3> colors;
    LutRecord record;
};

/// Of integer files only.
struct PngOptions {
    int bits = 8;                        ///< 8 or 16
    Encoding encoding = Encoding::srgb;  ///< said in the header, as a chunk that viewers know and as text
};

struct LutWriteReport {
    std::size_t clamped_texels = 0;  ///< texels with a channel below 0 or above 1 that a PNG could not hold
};

/// The bytes of the table as an EXR file (float32). @param path  what messages name
/// @throws FileError on a value beyond float32
std::string lut_exr_bytes(const std::filesystem::path& path, const LutTable& table);

/// Writes by extension: .exr (float32), .png, .csv (thickness_mm,r,g,b with every digit). Whole or not at
/// all. Throws FileError on another extension, a value beyond float32 (EXR) or a folder that cannot be
/// written; std::invalid_argument on an empty or too long table, a color or axis that is not finite, bits
/// other than 8 and 16.
LutWriteReport write_lut(const std::filesystem::path& path, const LutTable& table,
                         const PngOptions& png = {});

/// Writes the table as a strip that people can look at: 8-bit sRGB PNG, thickness from left (0 mm) to right,
/// colors between entries interpolated linearly in linear light, as hosts do. Colors above 1 are clamped.
/// @param path  ending in .png
/// @param width  pixels, 1 to 16384, else std::invalid_argument
/// @param height  as width
/// @return the texels of the table that were clamped
/// @throws FileError where the file is not .png or cannot be written
LutWriteReport write_lut_preview(const std::filesystem::path& path, const LutTable& table, int width = 512,
                                 int height = 64);

/// A table and what people should know about how it was read.
struct LutFile {
    LutTable table;
    std::vector<std::string> notes;
};

/// Reads what write_lut wrote: EXR gives the same float32 values, CSV the same doubles, PNG its rounded ones.
/// Throws FileError, naming the line of a CSV, on anything else.
LutFile read_lut(const std::filesystem::path& path);

struct BaseLutFile {
    BaseLut base;
    std::vector<std::string> notes;
};

/// Reads an image as a base lookup: thickness grows with x from the first texel (0 mm) to the last.
/// A table of matrices, nine channels M00 to M22 of one row, gives them: Mij takes channel j of the light on the
/// far side to channel i of the light coming through. Any other image gives brightness: an image of several rows
/// the mean of each column's linear light, color its Rec.709 luminance; each said in `notes`.
/// @param max_thickness_mm  of the last texel; without it the file's own, else 12 mm, which is said in
/// `notes` Throws FileError as read_image does, where the image is wider than max_lut_size or a brightness is
/// negative.
BaseLutFile read_base_lut(const std::filesystem::path& path, std::optional<double> max_thickness_mm = {});

// The formats behind it, for this folder alone.

using HeaderText = std::map<std::string, std::string>;

/// The record as header text, and back. Reading throws FileError, naming the key, where a value is not what
/// it should be or max_thickness_mm is missing.
HeaderText to_header_text(const LutRecord& record);
LutRecord to_lut_record(const HeaderText& text, const std::filesystem::path& path);

/// The axis in the text, if it has one. Throws FileError where its value is not a number above 0.
std::optional<double> axis_in(const HeaderText& text, const std::filesystem::path& path);

LutWriteReport write_lut_png(const std::filesystem::path& path, const LutTable& table, const PngOptions& png);
void write_lut_csv(const std::filesystem::path& path, const LutTable& table);
LutFile read_lut_csv(const std::filesystem::path& path);

}  // namespace skinglow::detail
