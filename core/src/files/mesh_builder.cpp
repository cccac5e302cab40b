#include "files/mesh_builder.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "files/polygon_cut.h"
#include "numerics/huge_pages.h"

namespace skinglow::detail {

std::span<glm::dvec3> MeshBuilder::add_vertices(std::size_t count) {
    const std::size_t first = vertices_.size();
    reserve_huge(vertices_, first + count);
    vertices_.resize(first + count);
    return std::span(vertices_).subspan(first);
}

std::span<glm::uvec3> MeshBuilder::add_triangles(std::size_t count) {
    const std::size_t first = triangles_.size();
    reserve_huge(triangles_, first + count);
    triangles_.resize(first + count);
    return std::span(triangles_).subspan(first);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners) {
    if (corners.size() == 3) {
        triangles_.emplace_back(corners[0], corners[1], corners[2]);
        return;
    }
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    polygons_.push_back({corners_.size(), triangles_.size()});
}

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles) {
    reserve_huge(vertices_, vertices);
    reserve_huge(triangles_, triangles);
}

TriangleMesh MeshBuilder::take() {
    if (triangles_.empty() && polygons_.empty()) {
        refuse_file(path_, "has no triangles", "give a mesh with faces");
    }
    check_positions();
    const std::vector<std::uint8_t> used = used_vertices();
    cut_polygons();
    drop_unused(used);
    return {std::move(vertices_), std::move(triangles_)};
}

void MeshBuilder::check_positions() const {
    if (vertices_.size() >= std::numeric_limits<std::uint32_t>::max()) {
        refuse_file(path_, "has more vertices than 32 bits can count", "reduce the mesh");
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const glm::dvec3& position = vertices_[i];
        if (std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z)) continue;
        refuse_file(path_, "has a position that is not finite", damaged_mesh_remedy,
                    "vertex " + std::to_string(i));
    }
}

std::vector<std::uint8_t> MeshBuilder::used_vertices() const {
    std::vector<std::uint8_t> used(vertices_.size(), 0);
    // Triangles and polygons are kept apart; a message counts faces in the file's order.
    std::size_t polygons_before = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = triangles_[i][k];
            if (corner < used.size()) {
                used[corner] = 1;
                continue;
            }
            while (polygons_before < polygons_.size() && polygons_[polygons_before].triangles_before <= i)
                ++polygons_before;
            refuse_corner(corner, i + polygons_before);
        }
    }
    std::size_t begin = 0;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
        for (; begin < polygons_[i].end; ++begin) {
            if (corners_[begin] >= used.size())
                refuse_corner(corners_[begin], i + polygons_[i].triangles_before);
            used[corners_[begin]] = 1;
        }
    }
    return used;
}

void MeshBuilder::refuse_corner(std::uint32_t corner, std::size_t face) const {
    refuse_file(path_, "has a face with vertex " + std::to_string(corner) + ", which does not exist",
                damaged_mesh_remedy, "face " + std::to_string(face));
}

void MeshBuilder::cut_polygons() {
    PolygonCutter cutter;
    std::size_t begin = 0;
    for (const Polygon& polygon : polygons_) {
        const auto corners = std::span(corners_).subspan(begin, polygon.end - begin);
        if (!cutter.cut(corners, vertices_, triangles_)) {
            refuse_file(
                path_,
                "has a polygon of " + std::to_string(corners.size()) + " corners that is too intricate",
                "cut it into triangles before you export it");
        }
        begin = polygon.end;
    }
    corners_ = {};
    polygons_ = {};
}

void MeshBuilder::drop_unused(const std::vector<std::uint8_t>& used) {
    if (std::accumulate(used.begin(), used.end(), std::size_t{0}) == used.size()) return;
    std::vector<std::uint32_t> new_index(used.size(), 0);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] == 0) continue;
        new_index[i] = count;
        vertices_[count++] = vertices_[i];
    }
    vertices_.resize(count);
    for (glm::uvec3& t : triangles_) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
}

void refuse_utf16(const std::filesystem::path& path, std::string_view content) {
    if (!content.starts_with("\xFF\xFE") && !content.starts_with("\xFE\xFF")) return;
    refuse_file(path, "is text of two bytes a letter (UTF-16)", "save it as UTF-8");
}

void refuse_group(const std::filesystem::path& path, const std::string& group,
                  const std::vector<std::string>& names) {
    constexpr std::size_t max_named = 20;
    const std::set<std::string> different(names.begin(), names.end());
    std::string known;
    std::size_t count = 0;
    for (const std::string& name : different) {
        if (name.empty() || count++ >= max_named) continue;
        known += (known.empty() ? "\"" : ", \"") + name + "\"";
    }
    if (count > max_named) known += " and " + std::to_string(count - max_named) + " more";
    refuse_file(path, "has no group \"" + group + "\"",
                known.empty() ? "it names none; read all of it" : "it has " + known);
}

}  // namespace skinglow::detail
