#include "files/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "files/mesh_builder.h"

namespace skinglow::detail {
namespace {

struct NamedType {
    std::string_view name;
    NumberType little_endian;
    NumberType big_endian;
};

template <class Number>
constexpr NamedType named(std::string_view name) {
    return {name, number_type<Number, false>, number_type<Number, true>};
}

constexpr std::array types = {
    named<std::int8_t>("char"),     named<std::int8_t>("int8"),     named<std::uint8_t>("uchar"),
    named<std::uint8_t>("uint8"),   named<std::int16_t>("short"),   named<std::int16_t>("int16"),
    named<std::uint16_t>("ushort"), named<std::uint16_t>("uint16"), named<std::int32_t>("int"),
    named<std::int32_t>("int32"),   named<std::uint32_t>("uint"),   named<std::uint32_t>("uint32"),
    named<float>("float"),          named<float>("float32"),        named<double>("double"),
    named<double>("float64")};

class HeaderReader {
  public:
    HeaderReader(const std::filesystem::path& path, std::string_view content)
        : path_(path), content_(content), rest_(content) {}

    PlyHeader read() {
        bool has_format = false;
        if (take_line() && take_word() != "ply") refuse("is not a PLY file");
        for (;;) {
            if (!take_line()) refuse("ends within its header");
            const std::string_view word = take_word();
            if (word == "end_header") break;
            if (word == "format") {
                read_format();
                has_format = true;
            } else if (!has_format && (word == "element" || word == "property")) {
                refuse_file(path_, "names no format first", damaged_mesh_remedy, "header");
            } else if (word == "element") {
                read_element();
            } else if (word == "property") {
                read_property();
            }  // else a comment
        }
        if (!has_format) refuse_file(path_, "names no format", damaged_mesh_remedy, "header");
        for (const PlyElement& element : header_.elements) {
            // Without this a count of 1e18 of nothing would run for ever.
            if (element.properties.empty() && element.count > 0) {
                refuse_file(path_, "has an element without properties", damaged_mesh_remedy, element.name);
            }
        }
        header_.size = content_.size() - rest_.size();
        return std::move(header_);
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        refuse_file(path_, what, damaged_mesh_remedy, "line " + std::to_string(line_number_));
    }

    /// Lines end as the first one does: by \n, also after \r, or by \r alone.
    bool take_line() {
        if (++line_number_ == 1) {
            const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
            if (rest_.substr(end).starts_with('\r') && !rest_.substr(end).starts_with("\r\n"))
                line_end_ = '\r';
        }
        const std::size_t length = rest_.find(line_end_);
        if (length == std::string_view::npos) {
            line_ = rest_;
            return line_number_ == 1;
        }
        line_ = rest_.substr(0, length);
        rest_.remove_prefix(length + 1);
        return true;
    }

    std::string_view take_word() {
        line_.remove_prefix(std::min(line_.find_first_not_of(" \t\r"), line_.size()));
        const std::string_view word = line_.substr(0, line_.find_first_of(" \t\r"));
        line_.remove_prefix(word.size());
        return word;
    }

    NumberType take_type() {
        const std::string_view name = take_word();
        const auto* found = std::find_if(types.begin(), types.end(),
                                         [&](const NamedType& type) { return type.name == name; });
        if (found == types.end()) refuse("has the unknown type \"" + std::string(name) + "\"");
        return is_big_endian_ ? found->big_endian : found->little_endian;
    }

    void read_format() {
        const std::string_view name = take_word();
        header_.is_binary = name != "ascii";
        is_big_endian_ = name == "binary_big_endian";
        if (header_.is_binary && !is_big_endian_ && name != "binary_little_endian")
            refuse("has the unknown format \"" + std::string(name) + "\"");
    }

    void read_element() {
        PlyElement element;
        element.name = take_word();
        const auto& known = header_.elements;
        if (std::any_of(known.begin(), known.end(),
                        [&](const auto& each) { return each.name == element.name; }))
            refuse("has the element " + element.name + " a second time");
        const std::string_view count = take_word();
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size())
            refuse("has a count that is no number");
        header_.elements.push_back(std::move(element));
    }

    void read_property() {
        if (header_.elements.empty()) refuse("has a property of no element");
        PlyElement& element = header_.elements.back();
        const std::string_view before = line_;
        std::optional<NumberType> count_type;
        if (take_word() == "list") {
            count_type = take_type();
            ++element.lists;
        } else {
            line_ = before;
        }
        const NumberType type = take_type();
        element.properties.push_back({std::string(take_word()), type, count_type, element.size});
        if (!count_type) element.size += type.size;
    }

    const std::filesystem::path& path_;
    std::string_view content_;
    std::string_view rest_;
    std::string_view line_;
    char line_end_ = '\n';
    bool is_big_endian_ = false;
    std::size_t line_number_ = 0;
    PlyHeader header_;
};

}  // namespace

std::optional<std::size_t> PlyElement::scalar(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == property && !properties[i].count_type) return i;
    }
    return std::nullopt;
}

PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view content) {
    return HeaderReader(path, content).read();
}

}  // namespace skinglow::detail
