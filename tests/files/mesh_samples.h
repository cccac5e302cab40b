#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "files/mesh_file.h"

/// What the tests of mesh files share.
namespace skinglow::test {

template <class Number>
void append(std::string& bytes, Number number, bool big_endian = false) {
    std::array<char, sizeof(Number)> raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if (big_endian == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

/// Volume that a closed mesh encloses; negative where it is wound inwards.
inline double signed_volume(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles()) {
        const glm::dvec3 origin = mesh.vertices().front();
        volume += glm::dot(mesh.vertices()[t.x] - origin,
                           glm::cross(mesh.vertices()[t.y] - origin, mesh.vertices()[t.z] - origin)) /
                  6.0;
    }
    return volume;
}

inline double surface_area(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles()) {
        const glm::dvec3& origin = mesh.vertices()[t.x];
        area += glm::length(glm::cross(mesh.vertices()[t.y] - origin, mesh.vertices()[t.z] - origin)) / 2.0;
    }
    return area;
}

inline std::string base64(const std::string& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[bits >> (18U - 6U * static_cast<unsigned>(k)) & 63U];
        }
    }
    return text;
}

/// Corners of the unit cube and its twelve triangles, wound outwards.
inline const std::vector<glm::vec3> cube_corners = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1},
                                                    {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
inline const std::vector<std::uint16_t> cube_triangles = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5,
                                                          0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6,
                                                          0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};

/// A glTF file of the cube: accessor 0 its corners (float), accessor 1 its indices; more may be appended.
struct GltfSample {
    std::string bytes;
    std::string views;
    std::string accessors;
    std::string nodes = R"([{"mesh": 0}])";
    std::string attributes = R"("POSITION": 0)";
    std::string primitive;  ///< further keys of it, each with a comma before
    std::string mesh;       ///< the same of the mesh
    std::string more;       ///< the same of the file
    std::string uri;        ///< else the bytes themselves

    GltfSample() {
        std::string positions;
        for (const glm::vec3& corner : cube_corners) {
            for (int i = 0; i < 3; ++i) append(positions, corner[i]);
        }
        add(positions, 5126, 8, "VEC3");
        std::string indices;
        for (const std::uint16_t index : cube_triangles) append(indices, index);
        add(indices, 5123, cube_triangles.size(), "SCALAR");
    }

    void add(const std::string& data, int component, std::size_t count, const std::string& type,
             const std::string& keys = {}) {
        const std::size_t view = static_cast<std::size_t>(std::count(views.begin(), views.end(), '{'));
        views += (views.empty() ? "" : ", ") + std::string(R"({"buffer": 0, "byteOffset": )") +
                 std::to_string(bytes.size()) + R"(, "byteLength": )" + std::to_string(data.size()) + "}";
        bytes += data;
        accessors += (accessors.empty() ? "" : ", ") + std::string(R"({"bufferView": )") +
                     std::to_string(view) + R"(, "componentType": )" + std::to_string(component) +
                     R"(, "count": )" + std::to_string(count) + R"(, "type": ")" + type + "\"" + keys + "}";
        bytes.resize((bytes.size() + 3) / 4 * 4);
    }

    std::string text() const {
        const std::string data = uri.empty() ? "data:application/octet-stream;base64," + base64(bytes) : uri;
        return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + std::to_string(bytes.size()) +
               R"(, "uri": ")" + data + R"("}], "bufferViews": [)" + views + R"(], "accessors": [)" +
               accessors + R"(], "meshes": [{"name": "cube", "primitives": [{"attributes": {)" + attributes +
               R"(}, "indices": 1)" + primitive + "}]" + mesh + R"(}], "nodes": )" + nodes + more + "}";
    }
};

}  // namespace skinglow::test
