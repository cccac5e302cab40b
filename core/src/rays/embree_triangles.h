#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>

namespace skinglow {

/// Triangles `begin` to below `end` of those given.
struct TriangleRange {
    std::uint32_t begin;
    std::uint32_t end;
};

/// Embree, behind a door of its own: nothing else of ours includes it. Embree 3 and 4 are both served. Single
/// precision: what is given should lie about the origin, at about the size of 1. All that is const may be
/// called from many threads at once.
class EmbreeTriangles {
  public:
    /// Copies the triangles and builds the acceleration structure. No ray slips through between two that
    /// share an edge. Throws std::runtime_error where Embree cannot work, or is not the version this was
    /// built for.
    EmbreeTriangles(std::span<const glm::dvec3> points, std::span<const glm::uvec3> corners);
    ~EmbreeTriangles();
    EmbreeTriangles(const EmbreeTriangles&) = delete;
    EmbreeTriangles& operator=(const EmbreeTriangles&) = delete;

    struct Hit {
        std::uint32_t triangle;
        float distance;
    };
    /// The first triangle along a ray, from a distance on, either side of it. @param direction  unit length
    std::optional<Hit> nearest(const glm::dvec3& origin, const glm::dvec3& direction, float from) const;

    /// Whether a triangle lies between two distances along a ray. @param direction  unit length
    /// @param without  triangles that do not count
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to,
                  std::span<const TriangleRange> without = {}) const;

  private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

}  // namespace skinglow
