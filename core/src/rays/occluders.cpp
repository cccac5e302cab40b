#include "rays/occluders.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "geometry/mesh_check.h"
#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// Ends of a ray, as a share of their coordinates: some ten roundings of single precision.
constexpr double end_share = 1e-6;
/// The same of a place at the very origin, in units of the scene.
constexpr double least_end = 1e-12;
/// Room around the box of all triangles, for what rounding moves a corner.
constexpr double box_room = 1e-6;

double reach_of(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// A stretch of a ray; nothing where `from` is above `to`.
struct Stretch {
    double from;
    double to;
};

/// The part of a ray that lies in a box.
Stretch inside_box(const glm::dvec3& start, const glm::dvec3& direction, const glm::dvec3& least,
                   const glm::dvec3& most) {
    Stretch part{0.0, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0) {
            if (start[k] < least[k] || start[k] > most[k]) return {1.0, 0.0};
            continue;
        }
        const double a = (least[k] - start[k]) / direction[k];
        const double b = (most[k] - start[k]) / direction[k];
        part.from = std::max(part.from, std::min(a, b));
        part.to = std::min(part.to, std::max(a, b));
    }
    return part;
}

/// With halves, because the difference of two huge coordinates may overflow where theirs does not.
glm::dvec3 halved_difference(const glm::dvec3& a, const glm::dvec3& b) {
    return 0.5 * a - 0.5 * b;
}

bool stops_light(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double size = std::max({reach_of(halved_difference(b, a)), reach_of(halved_difference(c, a)),
                                  reach_of(halved_difference(c, b))});
    if (size == 0.0) return false;
    // Of size 1, so that no square over- or underflows.
    const glm::dvec3 u = halved_difference(b, a) / size;
    const glm::dvec3 v = halved_difference(c, a) / size;
    return has_area(glm::length(glm::cross(u, v)),
                    std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(v - u, v - u)}));
}

}  // namespace

Occluders::Occluders(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin) {
    if (origin) require_finite("origin", *origin);
    std::size_t corners_given = 0;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        require_mesh("meshes[" + std::to_string(m) + "] ", meshes[m].vertices, meshes[m].triangles);
        corners_given += 3 * meshes[m].triangles.size();
    }
    if (corners_given > std::numeric_limits<std::uint32_t>::max()) {
        refuse_argument("number of triangles", std::to_string(corners_given / 3),
                        "a third of what 32 bits can count");
    }
    place(meshes, origin);
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> corners;
    for (const MeshView& mesh : meshes) {
        const auto begin = static_cast<std::uint32_t>(corners.size());
        const auto first = static_cast<std::uint32_t>(points.size());
        if (scale_ > 0.0) {
            // A vertex that no triangle uses may lie anywhere; it only has to be a number.
            for (const glm::dvec3& v : mesh.vertices) points.push_back(glm::clamp(local(v), -2.0, 2.0));
            for (const glm::uvec3& t : mesh.triangles) {
                if (stops_light(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]))
                    corners.push_back(t + first);
            }
        }
        ranges_.push_back({begin, static_cast<std::uint32_t>(corners.size())});
    }
    if (!corners.empty()) triangles_ = std::make_unique<EmbreeTriangles>(points, corners);
}

void Occluders::place(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin) {
    glm::dvec3 least(std::numeric_limits<double>::infinity());
    glm::dvec3 most(-std::numeric_limits<double>::infinity());
    for (const MeshView& mesh : meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                least = glm::min(least, mesh.vertices[t[k]]);
                most = glm::max(most, mesh.vertices[t[k]]);
            }
        }
    }
    if (!(least.x <= most.x)) return;
    origin_ = origin ? *origin : 0.5 * least + 0.5 * most;
    scale_ = 2.0 * std::max(reach_of(halved_difference(least, origin_)),
                            reach_of(halved_difference(most, origin_)));
    if (!std::isfinite(scale_)) {
        refuse_argument("meshes", "as far as " + to_text(most) + " from " + to_text(origin_),
                        "distances below the largest double");
    }
    if (scale_ == 0.0) return;
    least_ = local(least) - box_room;
    most_ = local(most) + box_room;
}

glm::dvec3 Occluders::local(const glm::dvec3& point) const {
    return halved_difference(point, origin_) / (0.5 * scale_);
}

std::vector<TriangleRange> Occluders::triangles_of(std::span<const std::size_t> meshes) const {
    std::vector<TriangleRange> found;
    for (const std::size_t mesh : meshes) {
        if (mesh >= ranges_.size()) {
            refuse_argument("mesh to leave out", std::to_string(mesh),
                            "below the number of meshes (" + std::to_string(ranges_.size()) + ")");
        }
        found.push_back(ranges_[mesh]);
    }
    return found;
}

bool Occluders::between(const glm::dvec3& point, const glm::dvec3& direction, double distance,
                        std::span<const TriangleRange> without) const {
    if (!triangles_) return false;
    const glm::dvec3 start = local(point);
    // So far off that all meshes together are a point to it.
    if (!std::isfinite(start.x) || !std::isfinite(start.y) || !std::isfinite(start.z)) return false;
    const Stretch box = inside_box(start, direction, least_, most_);
    const double away = distance / scale_;
    const double from = std::max({box.from, end_share * reach_of(start), least_end});
    const double to = std::min(box.to, away - end_share * (away + reach_of(start)) - least_end);
    if (!(from < to)) return false;
    // A ray from outside begins at the box: single precision would lose the box in a longer way.
    const glm::dvec3 moved = start + box.from * direction;
    return triangles_->occluded(moved, direction, static_cast<float>(from - box.from),
                                static_cast<float>(to - box.from), without);
}

}  // namespace skinglow
