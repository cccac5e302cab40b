#pragma once

#include <map>
#include <string>
#include <vector>

#include "files/lut_file.h"
#include "numerics/detail.h"

/// The formats behind lut_file.h. Not for use outside of this folder.
namespace skinglow::detail {

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
