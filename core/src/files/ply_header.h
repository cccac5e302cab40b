#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/number_bytes.h"

namespace skinglow::detail {

struct PlyProperty {
    std::string name;
    NumberType type;                       ///< in the file's byte order
    std::optional<NumberType> count_type;  ///< of a list
    std::size_t offset = 0;  ///< bytes from the element's begin on, as if lists before it were empty
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t lists = 0;  ///< how many of its properties are lists
    std::size_t size = 0;   ///< bytes of one in a binary file, without its lists

    /// Place of the property in `properties`. None where there is no such scalar.
    std::optional<std::size_t> scalar(std::string_view property) const;
};

struct PlyHeader {
    bool is_binary = false;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes up to the first element
};

/// Reads the header of a PLY file: G. Turk, "The PLY polygon file format" (1994), and the names of types with
/// their size that came into use later. @throws FileError naming the line
PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view content);

}  // namespace skinglow::detail
