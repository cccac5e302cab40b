#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "shape/body.h"

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

    /// The nearest point of the triangles that face along a normal (any, where it is 0); none where no
    /// triangle does. Of equally near ones the first in the tree.
    std::optional<SurfacePoint> nearest(const glm::vec3& point, const glm::vec3& facing) const;

  private:
    struct Node {
        glm::vec3 center;          ///< area-weighted
        float radius;              ///< of the ball about it that holds all triangles, mm
        glm::vec3 dipole;          ///< sum of area times normal, over 4 pi
        float far_sq;              ///< squared distance from which the dipole does
        std::uint32_t begin, end;  ///< of its triangles in order_
        std::uint32_t skip;        ///< the node after this one's descendants
        bool is_leaf;
    };
    void build(std::uint32_t begin, std::uint32_t end);

    const Body& body_;
    std::vector<std::uint32_t> order_;
    std::vector<glm::vec3> centers_;                 ///< of the triangles, while the tree is built
    std::vector<std::array<glm::vec3, 3>> corners_;  ///< of the triangles, as in order_
    std::vector<Node> nodes_;                        ///< depth first
};

}  // namespace skinglow::detail
