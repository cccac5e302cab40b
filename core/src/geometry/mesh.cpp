#include <skinglow/mesh.h>

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <string>
#include <utility>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

std::string entry(std::string_view prefix, const char* array, std::size_t i) {
    return std::string(prefix) + array + "[" + std::to_string(i) + "]";
}

void require_countable(std::string_view prefix, std::size_t vertices, std::size_t triangles) {
    constexpr std::size_t max_count = std::numeric_limits<std::uint32_t>::max() - 1;
    if (vertices <= max_count && triangles <= max_count / 3) return;
    refuse_argument(std::string(prefix) + "mesh",
                    std::to_string(vertices) + " vertices, " + std::to_string(triangles) + " triangles",
                    "numbers that 32 bits can count");
}

}  // namespace

MeshView::MeshView(std::span<const glm::dvec3> vertices, std::span<const glm::uvec3> triangles,
                   std::string_view prefix)
    : vertices_(vertices), triangles_(triangles) {
    require_countable(prefix, vertices.size(), triangles.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        require_finite([&] { return entry(prefix, "vertices", i); }, vertices[i]);
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3& t = triangles[i];
        if (std::max({t.x, t.y, t.z}) < vertices.size()) continue;
        refuse_argument(
            entry(prefix, "triangles", i),
            "(" + std::to_string(t.x) + ", " + std::to_string(t.y) + ", " + std::to_string(t.z) + ")",
            "indices below " + std::to_string(vertices.size()) + ", the number of vertices");
    }
}

TriangleMesh::TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles,
                           std::string_view prefix)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
    MeshView(vertices_, triangles_, prefix);  // checks
}

TriangleMesh::operator MeshView() const {
    MeshView view;
    view.vertices_ = vertices_;
    view.triangles_ = triangles_;
    return view;
}

std::optional<Box> box_of(std::span<const MeshView> meshes) {
    Box box{glm::dvec3(std::numeric_limits<double>::infinity()),
            glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (const MeshView& mesh : meshes) {
        for (const glm::uvec3& t : mesh.triangles()) {
            for (int k = 0; k < 3; ++k) {
                box.min = glm::min(box.min, mesh.vertices()[t[k]]);
                box.max = glm::max(box.max, mesh.vertices()[t[k]]);
            }
        }
    }
    if (box.min.x > box.max.x) return std::nullopt;
    return box;
}

}  // namespace skinglow
