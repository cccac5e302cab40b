#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "files/mesh_builder.h"
#include "files/ply_header.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {
namespace {

constexpr std::size_t block = 4096;  // rows at once, few enough to stay in the cache
constexpr double strip_end = -1.0;   // a triangle strip begins anew after it

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
            read_entries(element);
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

    /// Rows of a known size many at once, others one by one.
    void read_entries(const PlyElement& element) {
        const PlyProperty* list = list_of_rows(element);
        for (index_ = 0; index_ < element.count;) {
            const std::size_t rows = !header_.is_binary   ? 0
                                     : element.lists == 0 ? read_rows(element)
                                     : list != nullptr    ? read_triangles(element, *list)
                                                          : 0;
            if (rows == 0) read_entry(element);
            index_ += std::max<std::size_t>(rows, 1);
        }
    }

    bool are_corners(const PlyProperty& property) const {
        return (kind_ == Kind::faces || kind_ == Kind::strips) && property.count_type &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    /// The corners of faces that have no other list.
    const PlyProperty* list_of_rows(const PlyElement& element) const {
        if (kind_ != Kind::faces || element.lists != 1) return nullptr;
        const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                        [&](const PlyProperty& each) { return are_corners(each); });
        return found == element.properties.end() ? nullptr : &*found;
    }

    /// Some rows of an element without lists; none at the end of the file.
    std::size_t read_rows(const PlyElement& element) {
        const std::size_t rows = std::min({block, element.count - index_, rest_.size() / element.size});
        if (kind_ == Kind::vertices && rows > 0) {
            const std::span<glm::dvec3> vertices = builder_.add_vertices(rows);
            for (int axis = 0; axis < 3; ++axis) {
                const PlyProperty& property =
                    element.properties[coordinates_[static_cast<std::size_t>(axis)]];
                property.type.load_doubles(rest_.data() + property.offset, element.size, rows,
                                           &vertices[0][axis], 3);
            }
        }
        rest_.remove_prefix(rows * element.size);
        return rows;
    }

    /// The next rows that are triangles; none where the next one is not.
    std::size_t read_triangles(const PlyElement& element, const PlyProperty& list) {
        const std::size_t count_size = list.count_type->size;
        const std::size_t row = element.size + count_size + 3 * list.type.size;
        const std::size_t most = std::min({block, element.count - index_, rest_.size() / row});
        const char* counts = rest_.data() + list.offset;
        std::size_t rows = 0;
        if (count_size == 1) {
            while (rows < most && counts[rows * row] == 3) ++rows;
        } else {
            while (rows < most && list.count_type->load(counts + rows * row) == 3.0) ++rows;
        }
        if (rows == 0) return 0;
        const std::span<glm::uvec3> triangles = builder_.add_triangles(rows);
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t offset =
                list.offset + count_size + static_cast<std::size_t>(corner) * list.type.size;
            list.type.load_indices(rest_.data() + offset, row, rows, &triangles[0][corner], 3);
        }
        rest_.remove_prefix(rows * row);
        return rows;
    }

    void read_entry(const PlyElement& element) {
        values_.resize(element.properties.size());
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (property.count_type) {
                read_list(property);
            } else {
                values_[i] = take_value(property.type);
            }
        }
        if (kind_ == Kind::vertices) {
            builder_.add_vertex(
                {values_[coordinates_[0]], values_[coordinates_[1]], values_[coordinates_[2]]});
        }
    }

    void read_list(const PlyProperty& property) {
        const double count = take_value(*property.count_type);
        if (!(count >= 0.0)) refuse("has a list of no length");
        const bool wanted = are_corners(property);
        corners_.clear();
        const auto entries = static_cast<std::uint64_t>(std::min(count, 1e15));  // any file ends before
        for (std::uint64_t i = 0; i < entries; ++i) {
            const double value = take_value(property.type);
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

    double take_value(const NumberType& type) {
        if (!header_.is_binary) return take_text_number();
        if (rest_.size() < type.size) refuse("ends too early");
        const char* bytes = rest_.data();
        rest_.remove_prefix(type.size);
        return type.load(bytes);
    }

    double take_text_number() {
        constexpr std::string_view blanks = " \t\r\n\v\f";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
        if (rest_.empty()) refuse("ends too early");
        const auto number = take_number(rest_);
        if (!number || (!rest_.empty() && blanks.find(rest_.front()) == std::string_view::npos)) {
            refuse("has a value that is no number or not finite");
        }
        return *number;
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
