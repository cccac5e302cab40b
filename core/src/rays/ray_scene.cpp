#include "rays/ray_scene.h"

#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

/// Uncertainty of a hit's distance, in edges of the unit box: some ten roundings of single precision.
constexpr float hit_tolerance = 1e-6F;

/// Surfaces that a ray may cross.
constexpr std::size_t max_crossings = 256;

std::vector<glm::uvec3> corners_of(const WeldedMesh& mesh) {
    std::vector<glm::uvec3> corners;
    corners.reserve(mesh.triangles().size());
    for (const WeldedTriangle& t : mesh.triangles()) corners.push_back(t.corners);
    return corners;
}

bool has_corner(const WeldedTriangle& triangle, std::uint32_t welded) {
    return triangle.corners.x == welded || triangle.corners.y == welded || triangle.corners.z == welded;
}

bool share_corner(const WeldedTriangle& a, const WeldedTriangle& b) {
    return has_corner(a, b.corners.x) || has_corner(a, b.corners.y) || has_corner(a, b.corners.z);
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
               share_corner(mesh.triangles()[other.triangle], mesh.triangles()[crossing.triangle]);
    });
}

/// The first crossing at which the ray has left as many bodies as it has entered, the one it starts in
/// included.
/// @param crossings  ascending by distance
std::optional<std::uint32_t> first_exit(std::span<const Crossing> crossings, const WeldedMesh& mesh) {
    int bodies = 1;  // a ray that begins outside never reaches 0
    while (!crossings.empty()) {
        // What lies closer together than a hit is exact has no order: bodies that touch are one, so the ray
        // enters the next before it leaves the last.
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
    constexpr float unlimited = std::numeric_limits<float>::infinity();
    std::array<Crossing, max_crossings> crossings;
    std::size_t count = 0;
    float first_entry = unlimited;
    float limit = unlimited;  // what is nearer has been seen
    bool hopeful = true;
    const auto visitor = [&](float distance, std::uint32_t triangle) {
        // A ray meets the triangles of the vertex it starts from nowhere else: such a hit is a rounding
        // error.
        const WeldedTriangle& met = mesh_.triangles()[triangle];
        if (has_corner(met, welded) || (!dark.empty() && dark[triangle] != 0)) return unlimited;
        const double cosine = glm::dot(direction, met.unit_normal);
        if (cosine == 0.0 || count == max_crossings) return unlimited;
        crossings[count++] = {distance, triangle, cosine > 0.0};
        const float end = distance + hit_tolerance;
        if (cosine < 0.0) first_entry = std::min(first_entry, distance);
        if (cosine < 0.0 || !hopeful || first_entry <= end) return unlimited;
        limit = std::min(limit, end);
        return end;
    };
    // Mostly the first surface is the exit. Where the ray enters another body first, all crossings are needed.
    triangles_.visit(mesh_.positions()[welded], direction, hit_tolerance, std::cref(visitor));
    if (first_entry <= limit && limit < unlimited) {
        count = 0;
        hopeful = false;
        triangles_.visit(mesh_.positions()[welded], direction, hit_tolerance, std::cref(visitor));
    }
    if (count == max_crossings) return std::nullopt;  // a mesh so tangled gives no answer
    const std::span found = std::span(crossings).first(count);
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
        return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
    });
    return first_exit(found, mesh_);
}

}  // namespace skinglow::detail
