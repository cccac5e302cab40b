#pragma once

#include <skinglow/mesh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <utility>
#include <vector>

/// Meshes whose thickness is known, for tests and benchmarks. Wound counter-clockwise from outside.
namespace skinglow::shapes {

struct Mesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;

    MeshView view() const { return {vertices, triangles}; }

    void append(Mesh other) {  // by value: it may be this one
        const auto first = static_cast<std::uint32_t>(vertices.size());
        vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
        for (const glm::uvec3& t : other.triangles) triangles.push_back(t + first);
    }
    void flip() {
        for (glm::uvec3& t : triangles) std::swap(t.y, t.z);
    }
};

/// Octahedron, each triangle split in four `subdivisions` times and pushed out to the sphere: 4^(subdivisions + 1) + 2
/// vertices.
inline Mesh sphere(double radius, int subdivisions) {
    Mesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
              {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int round = 0; round < subdivisions; ++round) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
        const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, is_new] = midpoints.try_emplace(
                {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.push_back(glm::normalize(mesh.vertices[a] + mesh.vertices[b]));
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : mesh.triangles) {
            const std::uint32_t a = midpoint(t.x, t.y);
            const std::uint32_t b = midpoint(t.y, t.z);
            const std::uint32_t c = midpoint(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {a, t.y, b}, {c, b, t.z}, {a, b, c}});
        }
        mesh.triangles = std::move(finer);
    }
    for (glm::dvec3& v : mesh.vertices) v *= radius;
    return mesh;
}

/// Two spheres that face away from the wall between them; the outer one's vertices come first.
inline Mesh shell(double outer_radius, double wall, int subdivisions) {
    Mesh mesh = sphere(outer_radius, subdivisions);
    Mesh inner = sphere(outer_radius - wall, subdivisions);
    inner.flip();
    mesh.append(inner);
    return mesh;
}

/// From the origin to `size`, each face a grid of `cells` squared, its edge vertices its own as for flat
/// shading.
inline Mesh box(const glm::dvec3& size, std::uint32_t cells) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool far_side : {false, true}) {
            Mesh face;
            for (std::uint32_t i = 0; i <= cells; ++i) {
                for (std::uint32_t j = 0; j <= cells; ++j) {
                    glm::dvec3 v(0);
                    v[axis] = far_side ? size[axis] : 0.0;
                    v[(axis + 1) % 3] = size[(axis + 1) % 3] * i / cells;
                    v[(axis + 2) % 3] = size[(axis + 2) % 3] * j / cells;
                    face.vertices.push_back(v);
                    if (i == cells || j == cells) continue;
                    const std::uint32_t a = i * (cells + 1) + j;
                    const std::uint32_t b = a + cells + 1;
                    face.triangles.insert(face.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
                }
            }
            if (!far_side) face.flip();
            mesh.append(face);
        }
    }
    return mesh;
}

}  // namespace skinglow::shapes
