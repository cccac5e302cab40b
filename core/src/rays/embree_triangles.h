#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Triangles `begin` to below `end` of those given.
struct TriangleRange {
    std::uint32_t begin;
    std::uint32_t end;
};

/// Where a ray meets a triangle.
struct TriangleHit {
    float distance;
    std::uint32_t triangle;
    float u, v;  ///< barycentric, of the triangle's second and third corner
};

/// A ray between two distances.
struct RaySegment {
    glm::vec3 origin;
    glm::vec3 direction;  ///< unit length
    float from, to;
};

/// Told each hit of a ray, in no order: distance and triangle. Returns how far along the ray hits still
/// matter; infinity for no limit. Must not throw.
using HitVisitor = std::function<float(float distance, std::uint32_t triangle)>;

enum class HitFilters : std::uint8_t { off, on };

/// Triangles in Embree 3 or 4. The only file that includes Embree. Single precision: coordinates should lie
/// about the origin, at about the size of 1. All that is const may be called from many threads at once. Copies
/// share the structure.
class EmbreeTriangles {
  public:
    /// Copies the triangles and builds the acceleration structure. No ray slips through between two that
    /// share an edge. Throws as require_embree, and std::runtime_error where Embree fails.
    /// @param filters  whether hits can be visited and triangles excluded, which makes every ray slower
    EmbreeTriangles(std::span<const glm::dvec3> points, std::span<const glm::uvec3> corners,
                    HitFilters filters = HitFilters::on);

    /// Visits all triangles that a ray crosses from a distance on, either side of them, in one traversal;
    /// those beyond the limits that the visitor gives may be left out. A ray through an edge may hit both
    /// triangles there.
    /// @param direction  unit length
    void visit(const glm::dvec3& origin, const glm::dvec3& direction, float from,
               const HitVisitor& visitor) const;

    /// The nearest hit of a ray between two distances, on either side of a triangle; none where it meets nothing.
    /// @param direction  unit length
    std::optional<TriangleHit> nearest(const glm::dvec3& origin, const glm::dvec3& direction, float from,
                                       float to = std::numeric_limits<float>::infinity()) const;

    /// Whether a triangle lies between two distances along a ray.
    /// @param direction  unit length
    /// @param excluded   triangles that do not count
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to,
                  std::span<const TriangleRange> excluded = {}) const;

    /// The same of many rays, several at a time: fast where those that follow each other are alike.
    /// @param result  as many; 1 where a triangle lies in between, else 0
    void occluded(std::span<const RaySegment> rays, std::span<std::uint8_t> result) const;

  private:
    struct Handles;
    std::shared_ptr<Handles> handles_;
};

/// Throws std::runtime_error that says what to do, unless the Embree that answers in this process can serve:
/// another major version, or one without filter functions, gives wrong answers and no error.
/// @param version_major      its RTC_DEVICE_PROPERTY_VERSION_MAJOR
/// @param filter_functions   its RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED; 0: none
void require_embree(long version_major, long filter_functions);

}  // namespace skinglow::detail
