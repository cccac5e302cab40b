#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "files/mesh_builder.h"
#include "files/number_bytes.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {
namespace {

/// Words and numbers of a text file, one after the other; refuses naming the line.
class WordReader {
  public:
    WordReader(const std::filesystem::path& path, std::string_view text)
        : path_(path), text_(text), rest_(text) {}

    [[noreturn]] void refuse(const std::string& what) const {
        const std::string_view before = text_.substr(0, text_.size() - rest_.size());
        refuse_file(path_, what, damaged_mesh_remedy,
                    "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')));
    }

    /// The next word; empty at the end.
    std::string_view take() {
        constexpr std::string_view blanks = " \t\r\n\v\f";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
        rest_.remove_prefix(word.size());
        return word;
    }

    double take_number() {
        const std::string_view word = take();
        if (word.empty()) refuse("ends too early");
        const auto number = parse_number(word);
        if (!number) refuse("has \"" + std::string(word.substr(0, 40)) + "\" where a number belongs");
        return *number;
    }

    void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  private:
    const std::filesystem::path& path_;
    std::string_view text_;
    std::string_view rest_;
};

constexpr std::size_t header_bytes = 84;    // a text of 80 and the number of triangles
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, 16 bits of anything

void read_binary(std::string_view content, MeshBuilder& builder) {
    const std::size_t count = (content.size() - header_bytes) / triangle_bytes;
    const std::span<glm::dvec3> corners = builder.add_vertices(3 * count);
    const std::span<glm::uvec3> triangles = builder.add_triangles(count);
    for (std::size_t i = 0; i < count; ++i) {
        load_numbers<float, false>(content.data() + header_bytes + i * triangle_bytes + 12, sizeof(float), 9,
                                   &corners[3 * i].x, 1);
        const auto first = static_cast<std::uint32_t>(3 * i);
        triangles[i] = {first, first + 1, first + 2};
    }
}

/// In any mixture of capital and small letters.
bool is_word(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](unsigned char a, char b) {
        return std::tolower(a) == static_cast<unsigned char>(b);
    });
}

/// Text begins with "solid"; so do binary files of some programs, but with a zero byte soon after.
bool is_text(std::string_view content) {
    const std::string_view start = content.substr(0, 1024);
    const std::size_t first = std::min(start.find_first_not_of(" \t\r\n"), start.size());
    return is_word(start.substr(first, 5), "solid") && start.find('\0') == std::string_view::npos;
}

void read_text(const std::filesystem::path& path, std::string_view content, MeshBuilder& builder) {
    WordReader words(path, content);
    std::uint32_t count = 0;
    bool ended = false;
    for (std::string_view word = words.take(); !word.empty(); word = words.take()) {
        ended = is_word(word, "endsolid");
        if (is_word(word, "solid") || ended) {
            words.skip_line();  // a name, of any words
        } else if (is_word(word, "vertex")) {
            if (count >= 3) words.refuse("has a facet of more than three corners");
            glm::dvec3 position;
            for (int i = 0; i < 3; ++i) position[i] = words.take_number();
            builder.add_vertex(position);
            ++count;
        } else if (is_word(word, "endloop")) {
            if (count != 3) words.refuse("has a facet of fewer than three corners");
            const auto end = static_cast<std::uint32_t>(builder.vertex_count());
            builder.add_face(std::array{end - 3, end - 2, end - 1});
            count = 0;
        }
    }
    if (!ended) words.refuse("ends too early");
}

}  // namespace

MeshFile read_stl(const std::filesystem::path& path) {
    const std::string content = read_whole_file(path, max_mesh_bytes);
    refuse_utf16(path, content);
    std::string_view text = content;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    MeshBuilder builder(path);
    std::size_t triangles = 0;
    if (content.size() >= header_bytes) {
        triangles = static_cast<std::size_t>(load_number<std::uint32_t, false>(content.data() + 80));
    }
    // A binary file has the size that its count says.
    if (content.size() >= header_bytes && content.size() == header_bytes + triangles * triangle_bytes) {
        read_binary(content, builder);
    } else if (is_text(text)) {
        read_text(path, text, builder);
    } else {
        refuse_file(path, "has another size than its number of triangles says", damaged_mesh_remedy);
    }
    MeshFile file;
    file.mesh = joined(builder.take());
    return file;
}

}  // namespace skinglow::detail
