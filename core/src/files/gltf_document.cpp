#include "files/gltf_document.h"

#include <algorithm>
#include <array>
#include <system_error>

#include "files/mesh_builder.h"

namespace skinglow::detail {
namespace {

constexpr std::uint32_t glb_magic = 0x46546C67;  // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;
constexpr std::ptrdiff_t max_json_values = 4'000'000;

}  // namespace

bool is_readable_extension(std::string_view name) {
    constexpr std::array read = {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing"};
    // Of surfaces, pictures, lights and additional data: vertices and faces are the same without them.
    constexpr std::array harmless = {"KHR_materials_", "KHR_texture_",         "EXT_texture_",
                                     "MSFT_texture_",  "KHR_lights_",          "EXT_lights_",
                                     "KHR_xmp",        "KHR_animation_pointer"};
    return std::find(read.begin(), read.end(), name) != read.end() ||
           std::any_of(harmless.begin(), harmless.end(),
                       [&](const char* start) { return name.starts_with(start); });
}

GltfDocument::GltfDocument(const std::filesystem::path& path) : path_(path) {
    content_ = read_whole_file(path, max_mesh_bytes);
    std::string_view text = read_container();
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    // A value of two letters takes some dozen bytes of memory.
    const auto values = std::count_if(text.begin(), text.end(), [](char letter) {
        return letter == ',' || letter == '[' || letter == '{';
    });
    if (values > max_json_values)
        refuse("has more than " + std::to_string(max_json_values) + " values", "JSON");
    try {
        json_ = nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        refuse(std::string("is not glTF (") + error.what() + ")", "JSON");
    }
    if (!json_.is_object()) refuse("is not glTF", "JSON");
    check_version();
    check_extensions();
}

void GltfDocument::refuse(const std::string& what, const std::string& where) const {
    refuse_file(path_, what, damaged_mesh_remedy, where);
}

std::string_view GltfDocument::read_container() {
    const std::string_view content = content_;
    if (content.size() < 12 || word_at(content, 0) != glb_magic) return content;
    if (word_at(content, 4) != 2) {
        refuse_file(path_, "is of glTF version " + std::to_string(word_at(content, 4)),
                    "export it as glTF 2.0");
    }
    const std::size_t length = word_at(content, 8);
    if (length > content.size()) refuse("ends too early", "header");
    std::string_view text;
    for (std::size_t at = 12; at + 8 <= length;) {
        const std::size_t size = word_at(content, at);
        const std::uint32_t kind = word_at(content, at + 4);
        at += 8;
        if (size > length - at) refuse("ends too early", "chunk");
        if (kind == json_chunk && text.empty()) text = content.substr(at, size);
        if (kind == binary_chunk && !has_binary_) {
            binary_ = content.substr(at, size);
            has_binary_ = true;
        }
        at += size;
    }
    return text;
}

void GltfDocument::check_version() const {
    const auto asset = json_.find("asset");
    const std::string version = asset == json_.end() ? "unknown" : asset->value("version", "unknown");
    // A reader of 2.0 reads all of 2.x, unless the file says otherwise.
    const std::string needed = asset == json_.end() ? version : asset->value("minVersion", "2.0");
    if (!version.starts_with("2.") || needed != "2.0") {
        refuse_file(path_, "is of glTF version " + (version.starts_with("2.") ? needed : version),
                    "export it as glTF 2.0");
    }
}

void GltfDocument::check_extensions() const {
    const auto required = json_.find("extensionsRequired");
    if (required == json_.end()) return;
    for (const nlohmann::json& each : *required) {
        const auto name = each.get<std::string>();
        if (!is_readable_extension(name)) {
            refuse_file(path_, "demands the extension " + name + ", which is not read", "export it without");
        }
    }
}

const nlohmann::json& GltfDocument::entry(const char* list, std::size_t index) const {
    const auto found = json_.find(list);
    if (found == json_.end() || !found->is_array() || index >= found->size() ||
        !(*found)[index].is_object()) {
        refuse("does not exist", list + ("[" + std::to_string(index) + "]"));
    }
    return (*found)[index];
}

std::size_t GltfDocument::number(const nlohmann::json& object, const char* key,
                                 const std::string& where) const {
    const auto found = object.find(key);
    if (found == object.end()) refuse(std::string("has no ") + key, where);
    if (!found->is_number_unsigned()) refuse(std::string("has a ") + key + " that is no count", where);
    return found->get<std::size_t>();
}

std::size_t GltfDocument::number(const nlohmann::json& object, const char* key, const std::string& where,
                                 std::size_t otherwise) const {
    return object.contains(key) ? number(object, key, where) : otherwise;
}

const char* GltfDocument::view_bytes(std::size_t view, std::size_t offset, std::size_t count,
                                     std::size_t stride, std::size_t size, const std::string& where) {
    const nlohmann::json& entry = this->entry("bufferViews", view);
    const std::string view_name = "bufferViews[" + std::to_string(view) + "]";
    const std::string_view bytes = buffer(number(entry, "buffer", view_name));
    const std::size_t begin = number(entry, "byteOffset", view_name, 0);
    const std::size_t length = number(entry, "byteLength", view_name);
    if (begin > bytes.size() || length > bytes.size() - begin) refuse("runs beyond its buffer", view_name);
    if (offset > length || size > length - offset || (count - 1) > (length - offset - size) / stride) {
        refuse("runs beyond its buffer view", where);
    }
    return bytes.data() + begin + offset;
}

std::string_view GltfDocument::buffer(std::size_t index) {
    const nlohmann::json& entry = this->entry("buffers", index);
    const std::string where = "buffers[" + std::to_string(index) + "]";
    const std::size_t length = number(entry, "byteLength", where);
    const auto uri = entry.find("uri");
    const bool is_own = uri == entry.end() && index == 0 && has_binary_;
    if (uri == entry.end() && !is_own) {
        refuse_file(path_, "has a buffer without data, as compressed files have",
                    "export it without compression", where);
    }
    if (!is_own && !buffers_.contains(index)) buffers_[index] = read_uri(uri->get<std::string>(), where);
    const std::string_view bytes = is_own ? binary_ : std::string_view(buffers_.at(index));
    if (length > bytes.size()) refuse("has fewer bytes than it says", where);
    return bytes;
}

std::string GltfDocument::read_uri(const std::string& uri, const std::string& where) {
    std::string bytes;
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos) refuse("has a data URI without data", where);
        std::string_view data = std::string_view(uri).substr(comma + 1);
        const bool is_base64 = std::string_view(uri).substr(0, comma).ends_with(";base64");
        // Also base64 may have its + and / percent-encoded.
        std::string decoded;
        const bool is_plain = data.find('%') == std::string_view::npos;
        const bool is_decoded = is_plain || decode_percent(data, decoded);
        if (!is_plain) data = decoded;
        if (!is_base64) bytes = data;
        if (!is_decoded || (is_base64 && !decode_base64(data, bytes))) {
            refuse("has a data URI that cannot be decoded", where);
        }
        return bytes;
    }
    std::string name;
    if (!decode_percent(uri, name) || name.find('\0') != std::string::npos)
        refuse("has a URI with a stray %", where);
    if (name.find("://") != std::string::npos || name.starts_with("file:")) {
        refuse_file(path_, "keeps its data at " + name, "put the data beside it", where);
    }
    std::filesystem::path source = path_.parent_path() / name;
    std::error_code error;
    // Some write names as they are, in which a % is a %.
    if (!std::filesystem::exists(source, error)) source = path_.parent_path() / uri;
    if (!std::filesystem::is_regular_file(source, error)) {
        refuse_file(path_, "keeps its data in " + source.string() + ", which is not a file", "put it there",
                    where);
    }
    sources_.push_back(source);
    return read_whole_file(source, max_mesh_bytes);
}

}  // namespace skinglow::detail
