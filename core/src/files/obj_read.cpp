#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <vector>

#include "files/mesh_builder.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {
namespace {

constexpr std::string_view blanks_in_line = " \t\r\v\f";

/// Wavefront OBJ, "Appendix B1. Object Files" of Wavefront's Advanced Visualizer manual: vertices, faces,
/// groups and objects. Coordinates are doubles from the text's digits.
class ObjReader {
  public:
    ObjReader(const std::filesystem::path& path, const std::string& group)
        : path_(path), group_(group), builder_(path), wanted_(group.empty()) {}

    MeshFile read() {
        const std::string content = read_whole_file(path_, max_mesh_bytes);
        rest_ = content;
        refuse_utf16(path_, content);
        if (content.find('\n') == std::string::npos) line_end_ = '\r';
        if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
        while (!rest_.empty()) read_line(take_line());
        if (!group_.empty() && !found_group_) refuse_group(path_, group_, names_);
        MeshFile file;
        file.mesh = builder_.take();
        if (has_surfaces_) file.notes.emplace_back("its free-form curves and surfaces are not read");
        if (short_faces_ > 0) {
            file.notes.push_back(std::to_string(short_faces_) +
                                 " of its faces have fewer than three corners and were "
                                 "left out; was the file written to its end?");
        }
        return file;
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        refuse_file(path_, what, damaged_mesh_remedy, "line " + std::to_string(first_line_));
    }

    static std::string_view trimmed(std::string_view text) {
        text.remove_prefix(std::min(text.find_first_not_of(blanks_in_line), text.size()));
        return text.substr(0, text.find_last_not_of(blanks_in_line) + 1);
    }

    static std::string_view take_word(std::string_view& line) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks_in_line), line.size()));
        const std::string_view word = line.substr(0, line.find_first_of(blanks_in_line));
        line.remove_prefix(word.size());
        return word.starts_with('#') ? std::string_view() : word;
    }

    /// A line without its end, together with those that it goes on to by a backslash; a comment never goes
    /// on.
    std::string_view take_line() {
        std::string_view line = take_physical_line();
        first_line_ = line_;
        if (!line.ends_with('\\') || trimmed(line).starts_with('#')) return line;
        joined_.clear();
        for (; line.ends_with('\\') && !rest_.empty(); line = take_physical_line()) {
            joined_.append(line.substr(0, line.size() - 1)).append(" ");
        }
        return joined_.append(line);
    }

    std::string_view take_physical_line() {
        const std::size_t length = std::min(rest_.find(line_end_), rest_.size());
        std::string_view line = rest_.substr(0, length);
        rest_.remove_prefix(std::min(length + 1, rest_.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++line_;
        return line;
    }

    void read_line(std::string_view line) {
        const std::string_view word = take_word(line);
        if (word == "v") {
            read_vertex(line);
        } else if (word == "f" || word == "fo") {
            read_face(line);
        } else if (word == "o") {
            read_object(trimmed(line));
        } else if (word == "g") {
            read_groups(trimmed(line));
        } else if (word == "surf" || word == "curv") {
            has_surfaces_ = true;
        }
    }

    void read_vertex(std::string_view line) {
        glm::dvec3 position;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = take_word(line);
            const auto number = parse_number(word);
            if (!number) {
                refuse("has a vertex whose coordinate \"" + std::string(word.substr(0, 40)) +
                       "\" is no number or not finite");
            }
            position[i] = *number;
        }
        builder_.add_vertex(position);
    }

    void read_face(std::string_view line) {
        if (!wanted_) return;
        corners_.clear();
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            std::int64_t index = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
            if (error != std::errc() || (end != word.data() + word.size() && *end != '/')) {
                refuse("has a face whose corner \"" + std::string(word) + "\" is no number");
            }
            // From 1 on; a negative one counts back from the vertex that was read last.
            const std::int64_t resolved =
                index > 0 ? index - 1 : static_cast<std::int64_t>(builder_.vertex_count()) + index;
            if (index == 0 || resolved < 0 || resolved >= std::int64_t{0xFFFFFFFF}) {
                refuse("has a face with vertex " + std::to_string(index) + ", which does not exist");
            }
            corners_.push_back(static_cast<std::uint32_t>(resolved));
        }
        if (corners_.size() < 3) {
            ++short_faces_;
        } else {
            builder_.add_face(corners_);
        }
    }

    void read_object(std::string_view name) {
        in_object_ = name == group_;
        set_wanted(in_object_);
        note_name(name);
    }

    /// The names of several groups; also one name with spaces, as many programs write it.
    void read_groups(std::string_view names) {
        bool in_group = names == group_;
        note_name(names);
        for (std::string_view word = take_word(names); !word.empty(); word = take_word(names)) {
            in_group = in_group || word == group_;
        }
        set_wanted(in_group || in_object_);
    }

    void set_wanted(bool in_group) {
        wanted_ = group_.empty() || in_group;
        found_group_ = found_group_ || in_group;
    }

    void note_name(std::string_view name) {
        if (!group_.empty() && !found_group_) names_.emplace_back(name);
    }

    const std::filesystem::path& path_;
    const std::string& group_;
    MeshBuilder builder_;
    std::string_view rest_;
    std::string joined_;
    char line_end_ = '\n';  // \r alone in files of old Macs
    std::size_t line_ = 0;
    std::size_t first_line_ = 0;
    bool in_object_ = false;
    bool wanted_;
    bool found_group_ = false;
    bool has_surfaces_ = false;
    std::size_t short_faces_ = 0;
    std::vector<std::uint32_t> corners_;
    std::vector<std::string> names_;
};

}  // namespace

MeshFile read_obj(const std::filesystem::path& path, const std::string& group) {
    return ObjReader(path, group).read();
}

}  // namespace skinglow::detail
