#pragma once

#include <atomic>
#include <limits>
#include <optional>
#include <vector>

#include "rays/embree_triangles.h"
#include "shape/triangle_tree.h"

namespace skinglow::detail {

/// The surface of the flesh, for rays: a body's triangles without the walls that lie inside flesh. A wall is
/// inside where the surface winds about the point just outside it as well (the inner of two shells, an
/// eyeball pushed into a head): it carries no light, and rays pass it. May be asked from many threads at
/// once.
class FleshSurface {
  public:
    /// @param cell_mm  walls are told apart on a scale of about this length
    FleshSurface(const Body& body, double cell_mm);

    const Body& body() const { return *body_; }
    const TriangleTree& tree() const { return tree_; }

    /// Whether a point is in flesh.
    bool is_inside(const glm::vec3& point) const { return tree_.winding(point) > 0.5; }

    /// Whether a point of a triangle is a wall inside flesh.
    bool is_wall(std::uint32_t triangle, float u, float v) const {
        const Kind kind = kind_of(triangle);
        return kind == Kind::wall || (kind == Kind::mixed && lies_inside(triangle, u, v));
    }
    /// Whether all of a triangle is.
    bool is_all_wall(std::uint32_t triangle) const { return kind_of(triangle) == Kind::wall; }

    /// The nearest triangle of the body along a ray, up to a distance, that is no wall.
    /// @param direction  unit length
    std::optional<TriangleHit> nearest(const glm::vec3& origin, const glm::vec3& direction,
                                       float to = std::numeric_limits<float>::infinity()) const;

    /// Whether the surface stops a ray that begins at a point of it and goes outward.
    /// @param direction  unit length
    bool blocks(const glm::vec3& origin, const glm::vec3& direction, float to) const {
        return rays_.occluded(origin, direction, gap_, to);
    }

    /// The same of many rays; those that follow each other should be alike.
    /// @param rays    `from` is not looked at, and set
    /// @param result  as many, 1 where the surface stops it, else 0
    void block(std::span<RaySegment> rays, std::span<std::uint8_t> result) const {
        for (RaySegment& ray : rays) ray.from = gap_;
        rays_.occluded(rays, result);
    }

    /// What a ray that begins on the surface keeps away from it, mm.
    float gap() const { return gap_; }

  private:
    enum class Kind : std::uint8_t { unknown, surface, wall, mixed };
    bool lies_inside(std::uint32_t triangle, float u, float v) const;
    /// What a triangle is. Found out when it is first asked, and the same whoever asks.
    Kind kind_of(std::uint32_t triangle) const {
        const Kind known = kind_[triangle].load(std::memory_order_relaxed);
        return known != Kind::unknown ? known : find_kind(triangle);
    }
    Kind find_kind(std::uint32_t triangle) const;
    Kind find_large_kind(std::uint32_t triangle) const;
    /// Parts along an edge, each of which is asked.
    int parts_of(std::uint32_t triangle) const;

    const Body* body_;
    TriangleTree tree_;
    float cell_;
    float gap_;
    mutable std::vector<std::atomic<Kind>> kind_;
    EmbreeTriangles rays_;
};

}  // namespace skinglow::detail
