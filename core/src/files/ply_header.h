#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

enum class PlyCoding { text, little_endian, big_endian };

struct PlyType {
    std::string_view name;
    std::size_t size;                          ///< bytes
    double (*load_little)(const char* bytes);  ///< the number from its bytes, lowest first
    double (*load_big)(const char* bytes);     ///< highest first
};

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count_type;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    bool has_list = false;
    std::size_t size = 0;  ///< bytes of one in a binary file, without its lists

    /// Place of the property in `properties`. None where there is no such scalar.
    std::optional<std::size_t> scalar(std::string_view property) const;
};

struct PlyHeader {
    PlyCoding coding = PlyCoding::text;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes up to the first element
};

/// Reads the header of a PLY file: G. Turk, "The PLY polygon file format" (1994), and the names of types with
/// their size that came into use later. @throws FileError naming the line
PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view content);

}  // namespace skinglow::detail
