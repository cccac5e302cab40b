#include "geometry/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// Below this share of its longest edge's square, a triangle's area is rounding and its normal means nothing.
constexpr double smallest_area_share = 1e-12;

}  // namespace

bool has_area(double doubled_area, double longest) {
    return doubled_area > smallest_area_share * longest;
}

void require_mesh(const std::string& whose, std::span<const glm::dvec3> vertices,
                  std::span<const glm::uvec3> triangles) {
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 1;
    if (vertices.size() > most || triangles.size() > most / 3) {
        refuse_argument(
            whose + "mesh",
            std::to_string(vertices.size()) + " vertices, " + std::to_string(triangles.size()) + " triangles",
            "numbers that 32 bits can count");
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (!std::isfinite(vertices[i].x) || !std::isfinite(vertices[i].y) || !std::isfinite(vertices[i].z)) {
            refuse_argument(whose + "vertices[" + std::to_string(i) + "]", to_text(vertices[i]),
                            "three finite numbers");
        }
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3& t = triangles[i];
        if (std::max({t.x, t.y, t.z}) >= vertices.size()) {
            refuse_argument(
                whose + "triangles[" + std::to_string(i) + "]",
                "(" + std::to_string(t.x) + ", " + std::to_string(t.y) + ", " + std::to_string(t.z) + ")",
                "indices below " + std::to_string(vertices.size()) + ", the number of vertices");
        }
    }
}

}  // namespace skinglow
