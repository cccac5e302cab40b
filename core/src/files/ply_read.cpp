#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "files/mesh_builder.h"

namespace skinglow {
namespace {

enum class Coding { text, little_endian, big_endian };

struct NumberType {
    std::string_view name;
    std::size_t size;
    double (*load)(const char* bytes);  // of the machine's own byte order
};

template <class Number>
double load_number(const char* bytes) {
    Number number{};
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
}

// Names by G. Turk, "The PLY polygon file format" (1994), and the sized ones that came into use later.
constexpr std::array number_types = {
    NumberType{"char", 1, load_number<std::int8_t>},     NumberType{"int8", 1, load_number<std::int8_t>},
    NumberType{"uchar", 1, load_number<std::uint8_t>},   NumberType{"uint8", 1, load_number<std::uint8_t>},
    NumberType{"short", 2, load_number<std::int16_t>},   NumberType{"int16", 2, load_number<std::int16_t>},
    NumberType{"ushort", 2, load_number<std::uint16_t>}, NumberType{"uint16", 2, load_number<std::uint16_t>},
    NumberType{"int", 4, load_number<std::int32_t>},     NumberType{"int32", 4, load_number<std::int32_t>},
    NumberType{"uint", 4, load_number<std::uint32_t>},   NumberType{"uint32", 4, load_number<std::uint32_t>},
    NumberType{"float", 4, load_number<float>},          NumberType{"float32", 4, load_number<float>},
    NumberType{"double", 8, load_number<double>},        NumberType{"float64", 8, load_number<double>}};

struct Property {
    std::string name;
    NumberType type;
    std::optional<NumberType> count_type;  // of a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

class PlyReader {
  public:
    explicit PlyReader(const std::filesystem::path& path)
        : path_(path), content_(read_whole_file(path, max_mesh_bytes)), rest_(content_), builder_(path) {
        read_header();
        for (const Element& element : elements_) {
            for (std::size_t i = 0; i < element.count; ++i) read_entry(element, i);
        }
    }
    TriangleMesh take() { return builder_.take(); }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& where) const {
        refuse_file(path_, what, damaged_mesh_remedy, where);
    }

    std::string_view take_word(std::string_view& line) const {
        line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
        line.remove_prefix(word.size());
        return word;
    }

    NumberType number_type(std::string_view name, const std::string& where) const {
        const auto found = std::find_if(number_types.begin(), number_types.end(),
                                        [&](const NumberType& type) { return type.name == name; });
        if (found == number_types.end()) refuse("has the unknown type \"" + std::string(name) + "\"", where);
        return *found;
    }

    void read_header() {
        bool has_format = false;
        for (std::size_t line_number = 1;; ++line_number) {
            const std::size_t length = rest_.find('\n');
            const std::string where = "line " + std::to_string(line_number);
            if (length == std::string_view::npos) refuse("ends within its header", where);
            std::string_view line = rest_.substr(0, length);
            rest_.remove_prefix(length + 1);
            const std::string_view word = take_word(line);
            if (line_number == 1 && word != "ply") refuse("is not a PLY file", where);
            if (word == "end_header") break;
            if (word == "format") {
                read_format(take_word(line), where);
                has_format = true;
            } else if (word == "element") {
                read_element(line, where);
            } else if (word == "property") {
                read_property(line, where);
            }  // else a comment
        }
        if (!has_format) refuse("names no format", "header");
        for (const Element& element : elements_) {
            // Without this a count of 1e18 of nothing would run for ever.
            if (element.properties.empty() && element.count > 0)
                refuse("has an element without properties", element.name);
        }
    }

    void read_format(std::string_view name, const std::string& where) {
        if (name == "ascii") {
            coding_ = Coding::text;
        } else if (name == "binary_little_endian") {
            coding_ = Coding::little_endian;
        } else if (name == "binary_big_endian") {
            coding_ = Coding::big_endian;
        } else {
            refuse("has the unknown format \"" + std::string(name) + "\"", where);
        }
    }

    void read_element(std::string_view line, const std::string& where) {
        Element element;
        element.name = take_word(line);
        const std::string_view count = take_word(line);
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size())
            refuse("has a count that is no number", where);
        elements_.push_back(std::move(element));
    }

    void read_property(std::string_view line, const std::string& where) {
        if (elements_.empty()) refuse("has a property of no element", where);
        std::string_view type = take_word(line);
        std::optional<NumberType> count_type;
        if (type == "list") {
            count_type = number_type(take_word(line), where);
            type = take_word(line);
        }
        const NumberType value_type = number_type(type, where);
        elements_.back().properties.push_back({std::string(take_word(line)), value_type, count_type});
    }

    double take_number(const NumberType& type, const std::string& where) {
        return coding_ == Coding::text ? take_text_number(where) : take_binary_number(type, where);
    }

    double take_text_number(const std::string& where) {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
        if (rest_.starts_with('+')) rest_.remove_prefix(1);
        double number = 0.0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
        if (rest_.empty()) refuse("ends too early", where);
        if (error != std::errc()) refuse("has a value that is no number", where);
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return number;
    }

    double take_binary_number(const NumberType& type, const std::string& where) {
        if (rest_.size() < type.size) refuse("ends too early", where);
        std::array<char, 8> bytes{};
        std::copy_n(rest_.data(), type.size, bytes.data());
        const bool file_is_little = coding_ == Coding::little_endian;
        if (file_is_little != (std::endian::native == std::endian::little)) {
            std::reverse(bytes.data(), bytes.data() + type.size);
        }
        rest_.remove_prefix(type.size);
        return type.load(bytes.data());
    }

    void read_entry(const Element& element, std::size_t index) {
        const std::string where = element.name + " " + std::to_string(index);
        glm::dvec3 position{0.0};
        for (const Property& property : element.properties) {
            if (property.count_type) {
                read_list(element, property, where);
                continue;
            }
            const double value = take_number(property.type, where);
            if (property.name == "x") position.x = value;
            if (property.name == "y") position.y = value;
            if (property.name == "z") position.z = value;
        }
        if (element.name == "vertex") vertices_.push_back(builder_.add_vertex(position));
    }

    void read_list(const Element& element, const Property& property, const std::string& where) {
        const double count = take_number(*property.count_type, where);
        if (!(count >= 0.0)) refuse("has a list of no length", where);
        const bool is_face =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        corners_.clear();
        const auto entries = static_cast<std::uint64_t>(std::min(count, 1e15));  // any file ends before
        for (std::uint64_t i = 0; i < entries; ++i) {
            const double value = take_number(property.type, where);
            if (!is_face) continue;
            if (!(value >= 0.0 && value < static_cast<double>(vertices_.size()))) {
                refuse("has a vertex that does not exist", where);
            }
            corners_.push_back(vertices_[static_cast<std::size_t>(value)]);
        }
        for (std::size_t i = 2; i < corners_.size(); ++i)
            builder_.add_triangle(corners_[0], corners_[i - 1], corners_[i]);
    }

    const std::filesystem::path& path_;
    std::string content_;
    std::string_view rest_;
    MeshBuilder builder_;
    Coding coding_ = Coding::text;
    std::vector<Element> elements_;
    std::vector<std::uint32_t> vertices_;  // of the file, as vertices of the mesh
    std::vector<std::uint32_t> corners_;   // of one polygon
};

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& path) {
    return PlyReader(path).take();
}

}  // namespace skinglow
