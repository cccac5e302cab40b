#include "geometry/smooth_normals.h"

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>

#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

/// Faces at a vertex of which each is compared with each: where more meet, as at a fan's hub, a corner takes
/// them all, so that time grows with the mesh.
constexpr std::size_t most_compared = 256;

/// The corners at each vertex: those of vertex v from begin[v] on.
struct VertexCorners {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint32_t> corners;
};

VertexCorners corners_of_vertices(const MeshView& mesh) {
    VertexCorners found;
    found.begin.assign(mesh.vertices().size() + 1, 0);
    for (const glm::uvec3& t : mesh.triangles()) {
        for (int k = 0; k < 3; ++k) ++found.begin[t[k] + 1];
    }
    for (std::size_t v = 1; v < found.begin.size(); ++v) found.begin[v] += found.begin[v - 1];
    found.corners.resize(3 * mesh.triangles().size());
    std::vector<std::uint32_t> next(found.begin.begin(), found.begin.end() - 1);
    for (std::uint32_t c = 0; c < found.corners.size(); ++c)
        found.corners[next[mesh.triangles()[c / 3][static_cast<int>(c % 3)]]++] = c;
    return found;
}

}  // namespace

std::vector<glm::dvec3> smooth_normals(const MeshView& mesh, double sharp_angle) {
    const std::span<const glm::dvec3> vertices = mesh.vertices();
    std::vector<glm::dvec3> faces;
    std::vector<double> angles;  // of each corner
    faces.reserve(mesh.triangles().size());
    angles.reserve(3 * mesh.triangles().size());
    for (const glm::uvec3& t : mesh.triangles()) {
        faces.push_back(triangle_normal(vertices[t.x], vertices[t.y], vertices[t.z]));
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3& p = vertices[t[k]];
            angles.push_back(angle_between(vertices[t[(k + 1) % 3]] - p, vertices[t[(k + 2) % 3]] - p));
        }
    }
    const VertexCorners at = corners_of_vertices(mesh);
    const double least = std::cos(sharp_angle);
    std::vector<glm::dvec3> normals(angles.size(), glm::dvec3(0.0));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const auto corners = std::span(at.corners).subspan(at.begin[v], at.begin[v + 1] - at.begin[v]);
        const bool all = corners.size() > most_compared;
        glm::dvec3 sum(0.0);
        if (all) {
            for (const std::uint32_t c : corners) sum += angles[c] * faces[c / 3];
        }
        for (const std::uint32_t c : corners) {
            const glm::dvec3& face = faces[c / 3];
            if (face == glm::dvec3(0.0)) continue;
            glm::dvec3 normal = all ? sum : glm::dvec3(0.0);
            if (!all) {
                for (const std::uint32_t other : corners) {
                    if (glm::dot(face, faces[other / 3]) > least) normal += angles[other] * faces[other / 3];
                }
            }
            // Faces that cancel out, as of a doubled sheet, have no mean.
            normals[c] = glm::dot(normal, face) > 0.0 ? unit(normal) : face;
        }
    }
    return normals;
}

}  // namespace skinglow::detail
