#include "rays/ray_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

/// Uncertainty of a hit's distance, in edges of the unit box: some ten roundings of single precision.
constexpr float hit_tolerance = 1e-6F;

std::vector<glm::uvec3> corners_of(const WeldedMesh& mesh) {
    std::vector<glm::uvec3> corners;
    corners.reserve(mesh.triangles().size());
    for (const WeldedTriangle& t : mesh.triangles()) corners.push_back(t.corners);
    return corners;
}

bool share_corner(const glm::uvec3& a, const glm::uvec3& b) {
    for (int k = 0; k < 3; ++k) {
        if (a[k] == b.x || a[k] == b.y || a[k] == b.z) return true;
    }
    return false;
}

/// One passage of a ray through a surface.
struct Crossing {
    float distance;
    std::uint32_t triangle;
    bool leaves;  ///< out of a body; else into one
};

/// A crossing that an earlier one stands for: a ray through an edge or a corner hits each triangle there.
bool is_repeated(std::span<const Crossing> earlier, const Crossing& crossing, const WeldedMesh& mesh) {
    return std::any_of(earlier.begin(), earlier.end(), [&](const Crossing& other) {
        return other.leaves == crossing.leaves &&
               share_corner(mesh.triangles()[other.triangle].corners, mesh.triangles()[crossing.triangle].corners);
    });
}

/// The first crossing at which the ray has left as many bodies as it has entered, the one it starts in included.
/// @param crossings  ascending by distance
std::optional<std::uint32_t> first_way_out(std::span<const Crossing> crossings, const WeldedMesh& mesh) {
    int bodies = 1;  // a ray that begins outside never reaches 0
    while (!crossings.empty()) {
        // What lies closer together than a hit is exact has no order: bodies that touch are one, so the ray enters
        // the next before it leaves the last.
        const float end = crossings.front().distance + hit_tolerance;
        std::size_t count = 1;
        while (count < crossings.size() && crossings[count].distance <= end) ++count;
        for (const bool leaves : {false, true}) {
            for (std::size_t i = 0; i < count; ++i) {
                const Crossing& crossing = crossings[i];
                if (crossing.leaves != leaves || is_repeated(crossings.first(i), crossing, mesh)) continue;
                bodies += leaves ? -1 : 1;
                if (bodies == 0) return crossing.triangle;
            }
        }
        crossings = crossings.subspan(count);
    }
    return std::nullopt;
}

}  // namespace

RayScene::RayScene(const WeldedMesh& mesh) : mesh_(mesh), triangles_(mesh.positions(), corners_of(mesh)) {}

double RayScene::sky_visibility(std::uint32_t triangle, std::span<const glm::dvec3> directions) const {
    const WeldedTriangle& t = mesh_.triangles()[triangle];
    const auto& p = mesh_.positions();
    const glm::dvec3 center = (p[t.corners.x] + p[t.corners.y] + p[t.corners.z]) / 3.0;
    const glm::dmat3 frame = frame_around(t.unit_normal);
    const auto free = std::count_if(directions.begin(), directions.end(), [&](const glm::dvec3& local) {
        // From past the triangle that the ray starts on.
        return !triangles_.occluded(center, frame * local, hit_tolerance,
                                    std::numeric_limits<float>::infinity());
    });
    return static_cast<double>(free) / static_cast<double>(directions.size());
}

std::optional<std::uint32_t> RayScene::exit_triangle(std::uint32_t welded, const glm::dvec3& direction,
                                                     std::span<const std::uint8_t> dark) const {
    RayHits found;
    triangles_.crossings(mesh_.positions()[welded], direction, hit_tolerance, found);
    if (found.overflowed) return std::nullopt;  // a mesh so tangled gives no answer
    const auto own = mesh_.triangles_at(welded);
    std::array<Crossing, RayHits::max_count> crossings;
    std::size_t count = 0;
    for (const auto& [distance, triangle] : std::span(found.hits).first(found.count)) {
        // A ray meets the triangles of the vertex it starts from nowhere else: such a hit is a rounding error.
        if (std::binary_search(own.begin(), own.end(), triangle)) continue;
        if (!dark.empty() && dark[triangle] != 0) continue;
        const double cosine = glm::dot(direction, mesh_.triangles()[triangle].unit_normal);
        if (cosine != 0.0) crossings[count++] = {distance, triangle, cosine > 0.0};
    }
    std::sort(crossings.begin(), crossings.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Crossing& a, const Crossing& b) {
                  return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
              });
    return first_way_out(std::span(crossings).first(count), mesh_);
}

}  // namespace skinglow::detail
