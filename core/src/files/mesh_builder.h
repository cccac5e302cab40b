#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>

#include "files/mesh_file.h"
#include "rig_files/file_error.h"

/// What the mesh readers of this folder share. Not for use outside of it.
namespace skinglow {

constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t{2} << 30U;
constexpr const char* damaged_mesh_remedy =
    "the file is damaged or was not written to its end; export it anew";

/// A position by its bits: only what is exactly one point is one vertex.
struct PositionHash {
    std::size_t operator()(const glm::dvec3& position) const {
        std::uint64_t hash = 0;
        for (int i = 0; i < 3; ++i) {
            const auto bits = std::bit_cast<std::uint64_t>(position[i] + 0.0);  // -0 is 0
            hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;                       // 2^64 over the golden ratio
            hash ^= hash >> 32U;
        }
        return hash;
    }
};

/// Builds a mesh in which each position is one vertex.
class MeshBuilder {
  public:
    explicit MeshBuilder(const std::filesystem::path& path) : path_(path) {}

    /// The vertex at the position. Throws FileError where it is not finite or there are too many.
    std::uint32_t vertex_at(const glm::dvec3& position) {
        const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
        const auto [place, is_new] = vertex_of_.try_emplace(position, next);
        if (!is_new) return place->second;
        if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
            refuse_file(path_, "has a position that is not finite", damaged_mesh_remedy,
                        "vertex " + std::to_string(next));
        }
        mesh_.vertices.push_back(position);
        return next;
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh_.triangles.emplace_back(a, b, c);
    }

    /// The finished mesh. Throws FileError where it has no triangle.
    TriangleMesh take() {
        if (mesh_.triangles.empty()) refuse_file(path_, "has no triangles", "give a mesh with faces");
        return std::move(mesh_);
    }

  private:
    const std::filesystem::path& path_;
    TriangleMesh mesh_;
    std::unordered_map<glm::dvec3, std::uint32_t, PositionHash> vertex_of_;
};

/// PLY by a reader of our own: Assimp's (5.2.5) crashes or runs for ever on files that end too early.
TriangleMesh read_ply(const std::filesystem::path& path);

}  // namespace skinglow
