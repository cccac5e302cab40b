#include <algorithm>
#include <array>

#include "files/gltf_document.h"
#include "files/mesh_builder.h"
#include "files/number_bytes.h"

namespace skinglow::detail {
namespace {

/// Accessors with no bytes behind them are refused beyond this.
constexpr std::size_t max_zeros = 10'000'000;

struct ComponentType {
    std::size_t code;
    std::size_t size;
    double (*load)(const char* bytes);
    double max;  ///< what a normalized one is divided by; 0: cannot be normalized
};

constexpr std::array component_types = {
    ComponentType{5120, 1, load_number<std::int8_t, false>, 127.0},
    ComponentType{5121, 1, load_number<std::uint8_t, false>, 255.0},
    ComponentType{5122, 2, load_number<std::int16_t, false>, 32767.0},
    ComponentType{5123, 2, load_number<std::uint16_t, false>, 65535.0},
    ComponentType{5125, 4, load_number<std::uint32_t, false>, 4294967295.0},
    ComponentType{5126, 4, load_number<float, false>, 0.0}};

std::size_t component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    return type == "VEC4" ? 4 : 16;  // MAT2 and MAT3 are never asked for
}

std::string accessor_name(std::size_t index) {
    return "accessors[" + std::to_string(index) + "]";
}

}  // namespace

std::size_t GltfDocument::accessor_count(std::size_t index) const {
    return number(entry("accessors", index), "count", accessor_name(index));
}

std::vector<double> GltfDocument::read_accessor(std::size_t index, std::string_view type) {
    const std::string where = accessor_name(index);
    const nlohmann::json& accessor = entry("accessors", index);
    if (accessor.value("type", "") != type) refuse("is not of type " + std::string(type), where);
    const auto component = [&](const nlohmann::json& object) {
        const std::size_t code = number(object, "componentType", where);
        const auto* found = std::find_if(component_types.begin(), component_types.end(),
                                         [&](const ComponentType& each) { return each.code == code; });
        if (found == component_types.end())
            refuse("has the unknown componentType " + std::to_string(code), where);
        return *found;
    };
    const ComponentType kind = component(accessor);
    const std::size_t components = component_count(type);
    const std::size_t size = kind.size * components;
    const std::size_t count = number(accessor, "count", where);
    if (count == 0) return {};
    const double scale = accessor.value("normalized", false) && kind.max > 0.0 ? 1.0 / kind.max : 0.0;
    const auto load = [&](const char* bytes) {
        const double value = kind.load(bytes);
        return scale > 0.0 ? std::max(value * scale, -1.0) : value;
    };
    std::vector<double> values;
    if (accessor.contains("bufferView")) {
        const std::size_t view = number(accessor, "bufferView", where);
        const std::size_t stride = number(entry("bufferViews", view), "byteStride", where, size);
        if (stride < size)
            refuse("has elements that overlap (byteStride " + std::to_string(stride) + ")", where);
        const char* bytes =
            view_bytes(view, number(accessor, "byteOffset", where, 0), count, stride, size, where);
        values.resize(count * components);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < components; ++k) {
                values[i * components + k] = load(bytes + i * stride + k * kind.size);
            }
        }
    } else {
        if (count > max_zeros) refuse("has " + std::to_string(count) + " elements and no data", where);
        values.resize(count * components);
    }
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end()) return values;
    const std::size_t changed = number(*sparse, "count", where);
    if (changed == 0) return values;
    const nlohmann::json& indices = sparse->at("indices");
    const ComponentType index_kind = component(indices);
    const char* index_bytes =
        view_bytes(number(indices, "bufferView", where), number(indices, "byteOffset", where, 0), changed,
                   index_kind.size, index_kind.size, where);
    const nlohmann::json& new_values = sparse->at("values");
    const char* value_bytes =
        view_bytes(number(new_values, "bufferView", where), number(new_values, "byteOffset", where, 0),
                   changed, size, size, where);
    for (std::size_t i = 0; i < changed; ++i) {
        const double target = index_kind.load(index_bytes + i * index_kind.size);
        if (!(target >= 0.0 && target < static_cast<double>(count)))
            refuse("has a sparse index beyond its end", where);
        for (std::size_t k = 0; k < components; ++k) {
            values[static_cast<std::size_t>(target) * components + k] =
                load(value_bytes + i * size + k * kind.size);
        }
    }
    return values;
}

bool decode_base64(std::string_view text, std::string& bytes) {
    while (text.ends_with('=')) text.remove_suffix(1);
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char letter : text) {
        std::uint32_t digit = 0;
        if (letter >= 'A' && letter <= 'Z') {
            digit = static_cast<std::uint32_t>(letter - 'A');
        } else if (letter >= 'a' && letter <= 'z') {
            digit = static_cast<std::uint32_t>(letter - 'a') + 26;
        } else if (letter >= '0' && letter <= '9') {
            digit = static_cast<std::uint32_t>(letter - '0') + 52;
        } else if (letter == '+' || letter == '-') {
            digit = 62;
        } else if (letter == '/' || letter == '_') {
            digit = 63;
        } else {
            return false;
        }
        bits = (bits << 6U | digit) & 0xFFFFFFU;
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU);
        }
    }
    return true;
}

bool decode_percent(std::string_view text, std::string& bytes) {
    bytes.clear();
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            bytes += text[i];
            continue;
        }
        constexpr std::string_view digits = "0123456789abcdef";
        if (i + 2 >= text.size()) return false;
        const std::size_t high = digits.find(static_cast<char>(text[i + 1] | 0x20));
        const std::size_t low = digits.find(static_cast<char>(text[i + 2] | 0x20));
        if (high == std::string_view::npos || low == std::string_view::npos) return false;
        bytes += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return true;
}

}  // namespace skinglow::detail
