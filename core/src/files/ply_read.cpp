#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <vector>

#include "files/mesh_builder.h"
#include "files/ply_header.h"

namespace skinglow::detail {
namespace {

constexpr double strip_end = -1.0;  // a triangle strip begins anew after it

class PlyReader {
  public:
    explicit PlyReader(const std::filesystem::path& path)
        : path_(path),
          content_(read_whole_file(path, max_mesh_bytes)),
          header_(read_ply_header(path, content_)),
          rest_(std::string_view(content_).substr(header_.size)),
          builder_(path) {
        for (const PlyElement& element : header_.elements) {
            element_ = &element;
            begin(element);
            for (index_ = 0; index_ < element.count; ++index_) read_entry(element);
        }
    }
    TriangleMesh take() { return builder_.take(); }

  private:
    enum class Kind { other, vertices, faces, strips };

    [[noreturn]] void refuse(const std::string& what) const {
        refuse_file(path_, what, damaged_mesh_remedy, element_->name + " " + std::to_string(index_));
    }

    void begin(const PlyElement& element) {
        kind_ = element.name == "vertex"      ? Kind::vertices
                : element.name == "face"      ? Kind::faces
                : element.name == "tristrips" ? Kind::strips
                                              : Kind::other;
        if (kind_ == Kind::vertices) {
            constexpr std::array names = {"x", "y", "z"};
            for (std::size_t i = 0; i < 3; ++i) {
                const auto found = element.scalar(names[i]);
                if (!found) {
                    refuse_file(path_,
                                "has vertices without " + std::string(names[i]) + ": no body, no far side",
                                "export it anew with x, y and z", "header");
                }
                coordinates_[i] = *found;
            }
        }
        // Counts in a damaged header may be anything; what follows cannot be more than there are bytes.
        const std::size_t bytes = std::max<std::size_t>(element.size, 1);
        if (kind_ == Kind::vertices) builder_.reserve(std::min(element.count, rest_.size() / bytes), 0);
        if (kind_ == Kind::faces) builder_.reserve(0, std::min(element.count, rest_.size() / 4));
    }

    void read_entry(const PlyElement& element) {
        values_.resize(element.properties.size());
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (property.count_type) {
                read_list(property);
            } else {
                values_[i] = take_number(property.type);
            }
        }
        if (kind_ == Kind::vertices) {
            builder_.add_vertex(
                {values_[coordinates_[0]], values_[coordinates_[1]], values_[coordinates_[2]]});
        }
    }

    void read_list(const PlyProperty& property) {
        const double count = take_number(*property.count_type);
        if (!(count >= 0.0)) refuse("has a list of no length");
        const bool wanted = (kind_ == Kind::faces || kind_ == Kind::strips) &&
                            (property.name == "vertex_indices" || property.name == "vertex_index");
        corners_.clear();
        const auto entries = static_cast<std::uint64_t>(std::min(count, 1e15));  // any file ends before
        for (std::uint64_t i = 0; i < entries; ++i) {
            const double value = take_number(property.type);
            if (!wanted) continue;
            if (kind_ == Kind::strips && value == strip_end) {
                add_strip();
                continue;
            }
            if (!(value >= 0.0 && value < 4294967295.0)) refuse("has a vertex that does not exist");
            corners_.push_back(static_cast<std::uint32_t>(value));
        }
        if (!wanted) return;
        if (kind_ == Kind::strips) {
            add_strip();
        } else if (corners_.size() >= 3) {
            builder_.add_face(corners_);
        }
    }

    /// Every other triangle of a strip is wound the other way.
    void add_strip() {
        for (std::size_t i = 2; i < corners_.size(); ++i) {
            const std::size_t odd = i % 2;
            builder_.add_face(std::array{corners_[i - 2 + odd], corners_[i - 1 - odd], corners_[i]});
        }
        corners_.clear();
    }

    double take_number(const PlyType& type) {
        if (header_.coding == PlyCoding::text) return take_text_number();
        if (rest_.size() < type.size) refuse("ends too early");
        const char* bytes = rest_.data();
        rest_.remove_prefix(type.size);
        return header_.coding == PlyCoding::little_endian ? type.load_little(bytes) : type.load_big(bytes);
    }

    double take_text_number() {
        constexpr std::string_view blanks = " \t\r\n\v\f";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
        if (rest_.starts_with('+')) rest_.remove_prefix(1);
        double number = 0.0;
        const char* const last = rest_.data() + rest_.size();
        const auto [end, error] = std::from_chars(rest_.data(), last, number);
        if (rest_.empty()) refuse("ends too early");
        if (error != std::errc() || (end != last && blanks.find(*end) == std::string_view::npos)) {
            refuse("has a value that is no number");
        }
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return number;
    }

    const std::filesystem::path& path_;
    std::string content_;
    PlyHeader header_;
    std::string_view rest_;
    MeshBuilder builder_;
    const PlyElement* element_ = nullptr;
    std::size_t index_ = 0;
    Kind kind_ = Kind::other;
    std::array<std::size_t, 3> coordinates_{};
    std::vector<double> values_;          // the scalars of one element, by property
    std::vector<std::uint32_t> corners_;  // of one polygon or strip
};

}  // namespace

MeshFile read_ply(const std::filesystem::path& path) {
    MeshFile file;
    file.mesh = PlyReader(path).take();
    return file;
}

}  // namespace skinglow::detail
