#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "files/number_bytes.h"

namespace skinglow::detail {

/// Where an accessor's numbers are; checked to be in the file.
struct GltfAccessor {
    std::size_t count = 0;                   ///< elements
    std::size_t components = 1;              ///< numbers of each
    NumberType number;                       ///< how they are stored
    double scale = 0.0;                      ///< of normalized numbers; 0: these are not
    const char* bytes = nullptr;             ///< none: all are 0
    std::size_t stride = 0;                  ///< bytes from one element to the next
    const nlohmann::json* sparse = nullptr;  ///< what is substituted for some of them
    std::string where;                       ///< name for messages
};

/// A glTF 2.0 file: its JSON and the bytes that it refers to. Khronos Group, "glTF 2.0 Specification"
/// (ISO/IEC 12113). What a message names is a path in the JSON, such as "accessors[3]".
class GltfDocument {
  public:
    /// Reads a .gltf or .glb file.
    /// @throws FileError where it is damaged, of another version or demands an extension that is not read
    explicit GltfDocument(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    const nlohmann::json& json() const { return json_; }
    /// Files that buffers were read from.
    const std::vector<std::filesystem::path>& sources() const { return sources_; }

    /// An entry of one of the top-level lists. @throws FileError where there is none
    const nlohmann::json& entry(const char* list, std::size_t index) const;
    /// The whole number of that key. @throws FileError where it is missing, negative or no whole number
    std::size_t number(const nlohmann::json& object, const char* key, const std::string& where) const;
    std::size_t number(const nlohmann::json& object, const char* key, const std::string& where,
                       std::size_t otherwise) const;

    /// @param type  that it must have, such as "VEC3"
    GltfAccessor accessor(std::size_t index, std::string_view type);
    /// All components, one element after the other: normalized ones are in 0..1 or -1..1; sparse ones are
    /// filled in. There must be room for them.
    void read(const GltfAccessor& accessor, double* values);
    /// The same as indices; what is none becomes `no_index`.
    void read(const GltfAccessor& accessor, std::uint32_t* values);
    /// The same as a list of its own.
    std::vector<double> read_accessor(std::size_t index, std::string_view type);

    [[noreturn]] void refuse(const std::string& what, const std::string& where) const;

  private:
    /// The text of the JSON.
    std::string_view read_container();
    void check_version() const;
    void check_extensions() const;
    /// Bytes of a buffer view from an offset on that hold `count` elements `stride` apart, the last of `size`
    /// bytes.
    const char* view_bytes(std::size_t view, std::size_t offset, std::size_t count, std::size_t stride,
                           std::size_t size, const std::string& where);
    template <class Out>
    void read_numbers(const GltfAccessor& accessor, Out* values);
    std::string_view buffer(std::size_t index);
    std::string read_uri(const std::string& uri, const std::string& where);

    std::filesystem::path path_;
    nlohmann::json json_;
    std::string content_;
    std::string_view binary_;  ///< the GLB's own buffer
    bool has_binary_ = false;
    std::map<std::size_t, std::string> buffers_;
    std::vector<std::filesystem::path> sources_;
};

/// Whether the geometry can be read without knowing the extension, or it is one that is read.
bool is_readable_extension(std::string_view name);

/// Bytes of base64 (RFC 4648), padded or not. False where there is something else in it.
bool decode_base64(std::string_view text, std::string& bytes);
/// Bytes of a percent-encoded URI (RFC 3986). False where a % has no two digits.
bool decode_percent(std::string_view text, std::string& bytes);

}  // namespace skinglow::detail
