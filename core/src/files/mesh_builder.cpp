#include "files/mesh_builder.h"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "files/polygon_cut.h"
#include "geometry/weld.h"

namespace skinglow::detail {

void MeshBuilder::add_vertex(const glm::dvec3& position) {
    const std::size_t index = vertices_.size();
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
        refuse_file(path_, "has a position that is not finite", damaged_mesh_remedy,
                    "vertex " + std::to_string(index));
    }
    if (index >= std::numeric_limits<std::uint32_t>::max()) {
        refuse_file(path_, "has more vertices than 32 bits can count", "reduce the mesh");
    }
    vertices_.push_back(position);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners) {
    for (const std::uint32_t corner : corners) {
        if (corner < max_corner_) continue;
        max_corner_ = corner;
        face_of_max_ = faces_;
    }
    ++faces_;
    if (corners.size() == 3) {
        triangles_.emplace_back(corners[0], corners[1], corners[2]);
        return;
    }
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    polygon_ends_.push_back(corners_.size());
}

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles) {
    vertices_.reserve(vertices);
    triangles_.reserve(triangles);
}

TriangleMesh MeshBuilder::take() {
    if (faces_ == 0) refuse_file(path_, "has no triangles", "give a mesh with faces");
    check_corners();
    cut_polygons();
    drop_unused();
    const Weld welded = weld<glm::dvec3>(vertices_);
    for (glm::uvec3& t : triangles_) t = {welded.index[t.x], welded.index[t.y], welded.index[t.z]};
    for (std::size_t i = 0; i < welded.first.size(); ++i) vertices_[i] = vertices_[welded.first[i]];
    vertices_.resize(welded.first.size());
    return {std::move(vertices_), std::move(triangles_)};
}

void MeshBuilder::check_corners() const {
    if (max_corner_ < vertices_.size()) return;
    refuse_file(path_, "has a face with vertex " + std::to_string(max_corner_) + ", which does not exist",
                damaged_mesh_remedy, "face " + std::to_string(face_of_max_));
}

void MeshBuilder::cut_polygons() {
    PolygonCutter cutter;
    std::size_t begin = 0;
    for (const std::size_t end : polygon_ends_) {
        const auto corners = std::span(corners_).subspan(begin, end - begin);
        if (!cutter.cut(corners, vertices_, triangles_)) {
            refuse_file(
                path_,
                "has a polygon of " + std::to_string(corners.size()) + " corners that is too intricate",
                "cut it into triangles before you export it");
        }
        begin = end;
    }
    corners_ = {};
    polygon_ends_ = {};
}

void MeshBuilder::drop_unused() {
    std::vector<std::uint32_t> new_index(vertices_.size(), 0);
    for (const glm::uvec3& t : triangles_) new_index[t.x] = new_index[t.y] = new_index[t.z] = 1;
    std::uint32_t used = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        if (new_index[i] == 0) continue;
        new_index[i] = used;
        vertices_[used++] = vertices_[i];
    }
    if (used == vertices_.size()) return;
    vertices_.resize(used);
    for (glm::uvec3& t : triangles_) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
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
