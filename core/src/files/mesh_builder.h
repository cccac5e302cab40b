#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "files/mesh_file.h"
#include "geometry/weld.h"
#include "rig_files/file_error.h"

/// What the mesh readers of this folder share. Not for use outside of it.
namespace skinglow {

constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t{2} << 30U;
constexpr const char* damaged_mesh_remedy =
    "the file is damaged or was not written to its end; export it anew";

/// Builds a mesh in which each position is one vertex.
class MeshBuilder {
  public:
    explicit MeshBuilder(const std::filesystem::path& path) : path_(path) {}

    /// Returns the vertex's index for add_triangle. Throws FileError where it is not finite.
    std::uint32_t add_vertex(const glm::dvec3& position) {
        if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
            refuse_file(path_, "has a position that is not finite", damaged_mesh_remedy,
                        "vertex " + std::to_string(vertices_.size()));
        }
        vertices_.push_back(position);
        return static_cast<std::uint32_t>(vertices_.size() - 1);
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.emplace_back(a, b, c); }

    /// The finished mesh. Throws FileError where it has no triangle.
    TriangleMesh take() {
        if (triangles_.empty()) refuse_file(path_, "has no triangles", "give a mesh with faces");
        const Weld welded = weld<glm::dvec3>(vertices_);
        for (glm::uvec3& t : triangles_) t = {welded.index[t.x], welded.index[t.y], welded.index[t.z]};
        for (std::size_t i = 0; i < welded.first.size(); ++i) vertices_[i] = vertices_[welded.first[i]];
        vertices_.resize(welded.first.size());
        return {std::move(vertices_), std::move(triangles_)};
    }

  private:
    const std::filesystem::path& path_;
    std::vector<glm::dvec3> vertices_;
    std::vector<glm::uvec3> triangles_;
};

/// PLY by a reader of our own: Assimp's (5.2.5) crashes or runs for ever on files that end too early.
TriangleMesh read_ply(const std::filesystem::path& path);

}  // namespace skinglow
