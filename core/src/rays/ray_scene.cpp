#include "rays/ray_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "geometry/vector.h"
#include "rays/cone_sampling.h"

namespace skinglow {
namespace {

/// Step past a hit, in edges of the unit box. Single precision places a hit to some 1e-7 of it.
constexpr float step_past_hit = 1e-6F;
/// Surfaces a ray may cross; a mesh so tangled gives no answer rather than an endless loop.
constexpr int most_crossings = 256;

std::vector<glm::uvec3> corners_of(const WeldedMesh& mesh) {
    std::vector<glm::uvec3> corners;
    corners.reserve(mesh.triangles().size());
    for (const WeldedTriangle& t : mesh.triangles()) corners.push_back(t.corners);
    return corners;
}

}  // namespace

RayScene::RayScene(const WeldedMesh& mesh) : mesh_(mesh), triangles_(mesh.positions(), corners_of(mesh)) {}

double RayScene::openness(std::uint32_t triangle, std::span<const glm::dvec3> directions) const {
    const WeldedTriangle& t = mesh_.triangles()[triangle];
    const auto& p = mesh_.positions();
    const glm::dvec3 middle = (p[t.corners.x] + p[t.corners.y] + p[t.corners.z]) / 3.0;
    const glm::dmat3 frame = frame_around(t.unit_normal);
    std::size_t free = 0;
    for (const glm::dvec3& local : directions) {
        // From past the triangle that the ray starts on.
        if (!triangles_.occluded(middle, frame * local, step_past_hit,
                                 std::numeric_limits<float>::infinity()))
            ++free;
    }
    return static_cast<double>(free) / static_cast<double>(directions.size());
}

std::optional<std::uint32_t> RayScene::exit_triangle(std::uint32_t welded,
                                                     const glm::dvec3& direction) const {
    const auto own = mesh_.triangles_at(welded);
    const glm::dvec3& origin = mesh_.positions()[welded];
    float from = step_past_hit;
    int bodies =
        1;  // around the ray; the start counts as inside, so that a ray that begins outside never reaches 0
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        const auto hit = triangles_.nearest(origin, direction, from);
        if (!hit) return std::nullopt;
        from = hit->distance + step_past_hit;
        const std::uint32_t triangle = hit->triangle;
        // A ray meets the triangles of the vertex it starts from nowhere else: such a hit is a rounding
        // error.
        if (std::binary_search(own.begin(), own.end(), triangle)) continue;
        if (!closed_.empty() && closed_[triangle] != 0) continue;
        const double along = glm::dot(direction, mesh_.triangles()[triangle].unit_normal);
        if (along > 0 && --bodies == 0) return triangle;
        if (along < 0) ++bodies;
    }
    return std::nullopt;
}

}  // namespace skinglow
