#include <algorithm>
#include <array>

#include "files/gltf_document.h"

namespace skinglow::detail {
namespace {

/// Accessors with no bytes behind them are refused beyond this.
constexpr std::size_t max_zeros = 4'000'000;

struct ComponentType {
    std::size_t code;
    NumberType number;
    double max;  ///< what a normalized one is divided by; 0: cannot be normalized
};

constexpr std::array component_types = {ComponentType{5120, number_type<std::int8_t, false>, 127.0},
                                        ComponentType{5121, number_type<std::uint8_t, false>, 255.0},
                                        ComponentType{5122, number_type<std::int16_t, false>, 32767.0},
                                        ComponentType{5123, number_type<std::uint16_t, false>, 65535.0},
                                        ComponentType{5125, number_type<std::uint32_t, false>, 4294967295.0},
                                        ComponentType{5126, number_type<float, false>, 0.0}};

const ComponentType& component_type(const GltfDocument& document, const nlohmann::json& object,
                                    const std::string& where) {
    const std::size_t code = document.number(object, "componentType", where);
    const auto* found = std::find_if(component_types.begin(), component_types.end(),
                                     [&](const ComponentType& each) { return each.code == code; });
    if (found == component_types.end())
        document.refuse("has the unknown componentType " + std::to_string(code), where);
    return *found;
}

std::size_t component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC3") return 3;
    return type == "VEC4" ? 4 : 16;  // the others are never asked for
}

void load(const NumberType& type, const char* first, std::size_t stride, std::size_t count, double* out,
          std::size_t out_stride) {
    type.load_doubles(first, stride, count, out, out_stride);
}

void load(const NumberType& type, const char* first, std::size_t stride, std::size_t count,
          std::uint32_t* out, std::size_t out_stride) {
    type.load_indices(first, stride, count, out, out_stride);
}

void normalize(double* values, std::size_t count, double scale) {
    if (scale == 0.0) return;
    for (std::size_t i = 0; i < count; ++i) values[i] = std::max(values[i] * scale, -1.0);
}

void normalize(const std::uint32_t* /*values*/, std::size_t /*count*/, double /*scale*/) {}

}  // namespace

GltfAccessor GltfDocument::accessor(std::size_t index, std::string_view type) {
    const nlohmann::json& json = entry("accessors", index);
    GltfAccessor accessor;
    accessor.where = "accessors[" + std::to_string(index) + "]";
    if (json.value("type", "") != type) refuse("is not of type " + std::string(type), accessor.where);
    const ComponentType& kind = component_type(*this, json, accessor.where);
    accessor.number = kind.number;
    if (json.value("normalized", false) && kind.max > 0.0) accessor.scale = 1.0 / kind.max;
    accessor.components = component_count(type);
    const std::size_t size = kind.number.size * accessor.components;
    accessor.count = number(json, "count", accessor.where);
    if (accessor.count == 0) return accessor;
    if (json.contains("bufferView")) {
        const std::size_t view = number(json, "bufferView", accessor.where);
        accessor.stride = number(entry("bufferViews", view), "byteStride", accessor.where, size);
        if (accessor.stride < size) {
            refuse("has elements that overlap (byteStride " + std::to_string(accessor.stride) + ")",
                   accessor.where);
        }
        accessor.bytes = view_bytes(view, number(json, "byteOffset", accessor.where, 0), accessor.count,
                                    accessor.stride, size, accessor.where);
    } else if (accessor.count > max_zeros) {
        refuse("has " + std::to_string(accessor.count) + " elements and no data", accessor.where);
    }
    const auto sparse = json.find("sparse");
    if (sparse != json.end() && number(*sparse, "count", accessor.where) > 0) accessor.sparse = &*sparse;
    return accessor;
}

template <class Out>
void GltfDocument::read_numbers(const GltfAccessor& accessor, Out* values) {
    const std::size_t components = accessor.components;
    const std::size_t component_size = accessor.number.size;
    const std::size_t size = components * component_size;
    if (accessor.bytes == nullptr) {
        std::fill_n(values, accessor.count * components, Out(0));
    } else if (accessor.stride == size) {
        load(accessor.number, accessor.bytes, component_size, accessor.count * components, values, 1);
    } else {
        for (std::size_t k = 0; k < components; ++k) {
            load(accessor.number, accessor.bytes + k * component_size, accessor.stride, accessor.count,
                 values + k, components);
        }
    }
    if (accessor.sparse != nullptr) {
        const std::size_t changed = number(*accessor.sparse, "count", accessor.where);
        const auto sparse_bytes = [&](const nlohmann::json& part, std::size_t part_size) {
            return view_bytes(number(part, "bufferView", accessor.where),
                              number(part, "byteOffset", accessor.where, 0), changed, part_size, part_size,
                              accessor.where);
        };
        const nlohmann::json& indices = accessor.sparse->at("indices");
        const NumberType index = component_type(*this, indices, accessor.where).number;
        const char* index_bytes = sparse_bytes(indices, index.size);
        const char* value_bytes = sparse_bytes(accessor.sparse->at("values"), size);
        for (std::size_t i = 0; i < changed; ++i) {
            std::uint32_t target = no_index;
            index.load_indices(index_bytes + i * index.size, index.size, 1, &target, 1);
            if (target >= accessor.count) refuse("has a sparse index beyond its end", accessor.where);
            load(accessor.number, value_bytes + i * size, component_size, components,
                 values + target * components, 1);
        }
    }
    normalize(values, accessor.count * components, accessor.scale);
}

void GltfDocument::read(const GltfAccessor& accessor, double* values) {
    read_numbers(accessor, values);
}

void GltfDocument::read(const GltfAccessor& accessor, std::uint32_t* values) {
    read_numbers(accessor, values);
}

std::vector<double> GltfDocument::read_accessor(std::size_t index, std::string_view type) {
    const GltfAccessor found = accessor(index, type);
    std::vector<double> values(found.count * found.components);
    read(found, values.data());
    return values;
}

}  // namespace skinglow::detail
