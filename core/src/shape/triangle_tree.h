#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "shape/body.h"
#include "shape/winding_kernel.h"

namespace skinglow::detail {

/// A point of a body's surface.
struct SurfacePoint {
    std::uint32_t triangle;
    float u, v;  ///< barycentric, of the triangle's second and third corner
};

/// The triangles of a body in a tree: how often the surface winds about a point, and which of its points is
/// nearest. May be asked from many threads at once.
class TriangleTree {
  public:
    /// The body must outlive the tree.
    explicit TriangleTree(const Body& body);

    /// Generalized winding number: the solid angle of all triangles over 4 pi. 1 inside a closed body, 0
    /// outside, 2 where two bodies overlap, and in between where the mesh is open. Far triangles are taken
    /// together as a dipole (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson, "Fast winding numbers
    /// for soups and clouds", ACM Trans. Graph. 37(4), 2018), which is good to some hundredths; near ones are
    /// exact.
    double winding(const glm::vec3& point) const;

    /// The same of some points that lie near each other, at most PointCluster::capacity, in a fraction of the time. A node
    /// counts as far where it is far from all of them.
    void windings(std::span<const glm::vec3> points, std::span<float> result) const;

    /// Some triangles that lie near a triangle, itself among them; of each of them the same ones.
    std::span<const std::uint32_t> neighborhood(std::uint32_t triangle) const;

    /// The nearest point of the triangles that face along a normal (any, where it is 0); none where no
    /// triangle does. Of equally near ones the one that faces along it more, or the first in the tree.
    /// @param facing  unit, or 0
    std::optional<SurfacePoint> nearest(const glm::vec3& point, const glm::vec3& facing) const;

  private:
    void build(std::uint32_t begin, std::uint32_t end);

    const Body& body_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;               ///< of each triangle in order_
    std::vector<glm::vec3> centers_;                 ///< of the triangles, while the tree is built
    std::vector<std::array<glm::vec3, 3>> corners_;  ///< of the triangles, as in order_
    std::vector<TriangleNode> nodes_;
};

}  // namespace skinglow::detail
