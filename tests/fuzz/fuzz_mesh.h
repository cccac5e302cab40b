#pragma once

#include <skinglow/mesh.h>

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "fuzz_input.h"
#include "require.h"

namespace skinglow::fuzz {

/// A box or any few triangles, its corners moved; nothing where the mesh itself is refused.
inline std::optional<TriangleMesh> mesh_from(FuzzInput& input) {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
    if (input.flag()) {
        const glm::dvec3 size{input.near_decades(0.1, 20.0), input.near_decades(0.1, 20.0),
                              input.near_decades(0.1, 20.0)};
        for (unsigned i = 0; i < 8; ++i)
            vertices.push_back(size * glm::dvec3(i & 1U, i >> 1U & 1U, i >> 2U & 1U));
        triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
        for (std::size_t moved = input.below(4); moved > 0; --moved)
            vertices[input.below(vertices.size())] += input.vector_in(-2.0, 2.0);
    }
    for (std::size_t more = input.below(8); more > 0; --more) vertices.push_back(input.vector_in(-5.0, 5.0));
    if (!vertices.empty()) {
        const auto corner = [&] { return static_cast<unsigned>(input.below(vertices.size())); };
        for (std::size_t more = input.below(8); more > 0; --more) {
            const unsigned a = corner(), b = corner(), c = corner();
            triangles.emplace_back(a, b, c);
        }
    }
    std::optional<TriangleMesh> mesh;
    runs([&] { mesh.emplace(vertices, triangles); });
    return mesh;
}

}  // namespace skinglow::fuzz
