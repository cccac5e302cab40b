#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/mesh_file.h"
#include "rig_files/file_error.h"

/// What the mesh readers of this folder share. Not for use outside of it.
namespace skinglow::detail {

constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t{2} << 30U;
constexpr const char* damaged_mesh_remedy =
    "the file is damaged or was not written to its end; export it anew";

/// Collects the vertices and faces of a file and makes a mesh of them.
class MeshBuilder {
  public:
    explicit MeshBuilder(const std::filesystem::path& path) : path_(path) {}

    std::size_t vertex_count() const { return vertices_.size(); }
    std::size_t triangle_count() const { return triangles_.size(); }
    void add_vertex(const glm::dvec3& position) { vertices_.push_back(position); }
    /// Many vertices at once, to be filled in before anything else is added.
    std::span<glm::dvec3> add_vertices(std::size_t count);
    /// @param corners  indices of vertices, which may be added later; at least 3
    void add_face(std::span<const std::uint32_t> corners);
    /// Many triangles at once, to be filled in before anything else is added.
    std::span<glm::uvec3> add_triangles(std::size_t count);
    void reserve(std::size_t vertices, std::size_t triangles);

    /// The finished mesh: polygons cut into triangles, vertices of no face left out. @throws FileError where there is no face, one has a vertex that does not exist, or a
    /// position is not finite
    TriangleMesh take();

  private:
    struct Polygon {
        std::size_t end;               ///< of its corners, in `corners_`
        std::size_t triangles_before;  ///< how many triangles the file has before it
    };

    void check_positions() const;
    /// For each vertex 1 if a face uses it.
    std::vector<std::uint8_t> used_vertices() const;
    [[noreturn]] void refuse_corner(std::uint32_t corner, std::size_t face) const;
    void cut_polygons();
    void drop_unused(const std::vector<std::uint8_t>& used);

    const std::filesystem::path& path_;
    std::vector<glm::dvec3> vertices_;
    std::vector<glm::uvec3> triangles_;
    std::vector<std::uint32_t> corners_;  ///< of all polygons with more than three
    std::vector<Polygon> polygons_;
};

/// @throws FileError: the file has no such group; it has `names`
[[noreturn]] void refuse_group(const std::filesystem::path& path, const std::string& group,
                               const std::vector<std::string>& names);

/// @throws FileError where text has a mark of two bytes a letter
void refuse_utf16(const std::filesystem::path& path, std::string_view content);

/// The readers, by format.
MeshFile read_ply(const std::filesystem::path& path);
MeshFile read_stl(const std::filesystem::path& path);
MeshFile read_obj(const std::filesystem::path& path, const std::string& group);
MeshFile read_gltf(const std::filesystem::path& path, const std::string& group);

}  // namespace skinglow::detail
