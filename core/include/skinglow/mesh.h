#pragma once

#include <skinglow/box.h>

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Triangle meshes. A mesh is checked once, when it is made; whatever takes a mesh relies on that.
///
/// @code
/// std::vector<glm::dvec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
/// std::vector<glm::uvec3> triangles = {{0, 1, 2}};
/// const skinglow::TriangleMesh mesh(std::move(vertices), std::move(triangles));
/// const std::vector<double> mm = skinglow::thickness(mesh);  // thickness.h
/// @endcode
namespace skinglow {

/// A checked mesh whose arrays somebody else holds, unchanged for as long as the view is in use.
class MeshView {
  public:
    /// An empty mesh.
    MeshView() = default;
    /// @param vertices   positions, finite, in any unit
    /// @param triangles  three indices into `vertices` each, counter-clockwise seen from outside
    /// @param prefix     put before the array's name in messages, such as "meshes[2] "
    /// @throws std::invalid_argument naming the first vertex that is not finite or triangle whose index is
    ///         out of range, or where 32 bits cannot count them
    MeshView(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles,
             std::string_view prefix = {});

    std::span<const glm::dvec3> vertices() const { return vertices_; }
    std::span<const glm::uvec3> triangles() const { return triangles_; }

  private:
    friend class TriangleMesh;
    std::span<const glm::dvec3> vertices_;
    std::span<const glm::uvec3> triangles_;
};

/// A checked mesh that holds its arrays. Passes as a MeshView without a copy or another check.
class TriangleMesh {
  public:
    /// An empty mesh.
    TriangleMesh() = default;
    /// Parameters and errors as MeshView.
    TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles,
                 std::string_view prefix = {});

    const std::vector<glm::dvec3>& vertices() const { return vertices_; }
    const std::vector<glm::uvec3>& triangles() const { return triangles_; }
    // NOLINTNEXTLINE(google-explicit-constructor): a view of the mesh is the mesh
    operator MeshView() const;

  private:
    std::vector<glm::dvec3> vertices_;
    std::vector<glm::uvec3> triangles_;
};

/// The smallest box around all triangles; vertices that no triangle uses do not count. None without
/// triangles.
std::optional<Box> box_of(std::span<const MeshView> meshes);

}  // namespace skinglow
