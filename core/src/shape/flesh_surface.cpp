#include "shape/flesh_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace skinglow::detail {
namespace {

/// Rounding of coordinates in single precision, with a margin.
constexpr float rounding = 1e-6F;
/// A mixed triangle's walls are passed this often before the ray counts as ended.
constexpr int max_walls = 256;
/// Parts along an edge of a large triangle that are asked.
constexpr int max_edge_parts = 12;
constexpr float third = 1.0F / 3;

float largest_coordinate(const Body& body) {
    float largest = 0;
    for (const glm::vec3& p : body.positions())
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return largest;
}

std::vector<glm::dvec3> points_of(const Body& body) {
    return {body.positions().begin(), body.positions().end()};
}

std::vector<glm::uvec3> corners_of(const Body& body) {
    std::vector<glm::uvec3> corners;
    corners.reserve(body.triangles().size());
    for (const BodyTriangle& t : body.triangles()) corners.push_back(t.welded);
    return corners;
}

}  // namespace

FleshSurface::FleshSurface(const Body& body, double cell_mm)
    : body_(&body),
      tree_(body),
      cell_(static_cast<float>(cell_mm)),
      gap_(std::max(1e-3F * cell_, rounding * largest_coordinate(body))),
      kind_(body.triangles().size()),
      rays_(points_of(body), corners_of(body), HitFilters::off) {}

bool FleshSurface::lies_inside(std::uint32_t triangle, float u, float v) const {
    const BodyTriangle& t = body_->triangles()[triangle];
    return is_inside(body_->at(t, u, v) + t.normal * gap_);
}

FleshSurface::Kind FleshSurface::find_kind(std::uint32_t triangle) const {
    if (parts_of(triangle) > 1) return find_large_kind(triangle);
    // Its neighbors will be asked, too. Most are so small that one point of them tells.
    const std::span<const std::uint32_t> all = tree_.neighborhood(triangle);
    std::array<std::uint32_t, PointCluster::capacity> small{};
    std::array<glm::vec3, PointCluster::capacity> above{};
    std::array<float, PointCluster::capacity> winding{};
    std::size_t count = 0;
    for (const std::uint32_t f : all) {
        if (parts_of(f) > 1) continue;
        const BodyTriangle& t = body_->triangles()[f];
        above[count] = body_->at(t, third, third) + t.normal * gap_;
        small[count++] = f;
    }
    tree_.windings(std::span(above).first(count), winding);
    Kind result = Kind::unknown;
    for (std::size_t i = 0; i < count; ++i) {
        const Kind kind = winding[i] > 0.5F ? Kind::wall : Kind::surface;
        kind_[small[i]].store(kind, std::memory_order_relaxed);
        if (small[i] == triangle) result = kind;
    }
    return result;
}

int FleshSurface::parts_of(std::uint32_t triangle) const {
    const BodyTriangle& t = body_->triangles()[triangle];
    float edge = 0;
    for (int k = 0; k < 3; ++k)
        edge = std::max(edge, glm::length(body_->corner(t, k) - body_->corner(t, (k + 1) % 3)));
    return static_cast<int>(
        std::clamp(std::ceil(edge / (4 * cell_)), 1.0F, static_cast<float>(max_edge_parts)));
}

FleshSurface::Kind FleshSurface::find_large_kind(std::uint32_t triangle) const {
    const int parts = parts_of(triangle);
    const auto scale = static_cast<float>(parts);
    int inside = 0;
    int asked = 0;
    for (int i = 0; i < parts; ++i) {
        for (int j = 0; i + j < parts; ++j) {
            const float u = (static_cast<float>(i) + third) / scale;
            const float v = (static_cast<float>(j) + third) / scale;
            inside += lies_inside(triangle, u, v) ? 1 : 0;
            ++asked;
        }
    }
    const Kind kind = inside == 0 ? Kind::surface : (inside == asked ? Kind::wall : Kind::mixed);
    kind_[triangle].store(kind, std::memory_order_relaxed);
    return kind;
}

std::optional<TriangleHit> FleshSurface::nearest(const glm::vec3& origin, const glm::vec3& direction,
                                                 float to) const {
    float from = 0;
    for (int i = 0; i < max_walls; ++i) {
        const std::optional<TriangleHit> hit = rays_.nearest(origin, direction, from, to);
        if (!hit || !is_wall(hit->triangle, hit->u, hit->v)) return hit;
        from = hit->distance + gap_;
    }
    return std::nullopt;
}

}  // namespace skinglow::detail
