#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "files/mesh_builder.h"
#include "files/number_bytes.h"
#include "files/word_reader.h"

namespace skinglow::detail {
namespace {

constexpr std::size_t header_bytes = 84;    // a text of 80 and the number of triangles
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, 16 bits of anything

void add_triangle(MeshBuilder& builder, const std::array<glm::dvec3, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(builder.vertex_count());
    for (const glm::dvec3& corner : corners) builder.add_vertex(corner);
    builder.add_face(std::array{first, first + 1, first + 2});
}

void read_binary(std::string_view content, MeshBuilder& builder) {
    for (std::size_t at = header_bytes; at < content.size(); at += triangle_bytes) {
        std::array<glm::dvec3, 3> corners{};
        for (std::size_t i = 0; i < 9; ++i) {
            corners[i / 3][static_cast<int>(i % 3)] =
                load_number<float, false>(content.data() + at + 12 + 4 * i);
        }
        add_triangle(builder, corners);
    }
}

void read_text(const std::filesystem::path& path, std::string_view content, MeshBuilder& builder) {
    WordReader words(path, content);
    std::array<glm::dvec3, 3> corners{};
    std::size_t count = 0;
    bool ended = false;
    for (std::string_view word = words.take(); !word.empty(); word = words.take()) {
        ended = word == "endsolid";
        if (word == "solid" || word == "endsolid") {
            words.skip_line();  // a name, of any words
        } else if (word == "vertex") {
            if (count >= 3) words.refuse("has a facet of more than three corners");
            for (int i = 0; i < 3; ++i) corners[count][i] = words.take_number();
            ++count;
        } else if (word == "endloop") {
            if (count != 3) words.refuse("has a facet of fewer than three corners");
            add_triangle(builder, corners);
            count = 0;
        }
    }
    if (!ended) words.refuse("ends too early");
}

}  // namespace

MeshFile read_stl(const std::filesystem::path& path) {
    const std::string content = read_whole_file(path, max_mesh_bytes);
    MeshBuilder builder(path);
    std::size_t triangles = 0;
    if (content.size() >= header_bytes) {
        triangles = static_cast<std::size_t>(load_number<std::uint32_t, false>(content.data() + 80));
    }
    // Files of both kinds begin with "solid"; a binary one has the size that its count says.
    if (content.size() >= header_bytes && content.size() == header_bytes + triangles * triangle_bytes) {
        read_binary(content, builder);
    } else if (content.starts_with("solid")) {
        read_text(path, content, builder);
    } else {
        refuse_file(path, "has another size than its number of triangles says", damaged_mesh_remedy);
    }
    MeshFile file;
    file.mesh = builder.take();
    return file;
}

}  // namespace skinglow::detail
