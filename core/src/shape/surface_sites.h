#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "shape/triangle_tree.h"

namespace skinglow::detail {

/// A piece of a site: a triangle, seen from one of its corners.
struct SitePiece {
    std::uint32_t triangle;
    std::uint8_t corner;
};

/// A point whose exitance is asked: a vertex, which stands for the mean about it weighted by its hat
/// function, or a point.
struct Site {
    glm::vec3 position;  ///< mm
    glm::vec3 normal;    ///< unit, outward; 0 where there is no triangle
    std::uint32_t first_piece = 0;
    std::uint32_t pieces = 0;  ///< of a vertex; 0 of a point
    SurfacePoint point{};      ///< of a point
    bool on_surface = false;   ///< false: a vertex without triangles
};

/// All points that are asked. Vertices at one position whose triangles go smoothly on are one site.
class SurfaceSites {
  public:
    /// The vertices of the mesh given.
    explicit SurfaceSites(const Body& body);

    /// Points on the surface; each is moved to the nearest one of the triangles that face along its normal.
    /// @param normals  one each, unit, or 0: of any triangle; or none at all
    SurfaceSites(const Body& body, const TriangleTree& tree, std::span<const glm::vec3> points,
                 std::span<const glm::vec3> normals, int threads);

    const std::vector<Site>& sites() const { return sites_; }
    /// For each vertex or point given, its site.
    const std::vector<std::uint32_t>& site_of() const { return site_of_; }
    std::span<const SitePiece> pieces(const Site& site) const {
        return {pieces_.data() + site.first_piece, site.pieces};
    }
    /// The site, and of a vertex with large triangles points on them, no farther apart than a length: all
    /// that its exitance is the mean of.
    std::vector<glm::vec3> spread(const Body& body, const Site& site, float length) const;

    bool are_vertices() const { return are_vertices_; }

  private:
    std::vector<Site> sites_;
    std::vector<std::uint32_t> site_of_;
    std::vector<SitePiece> pieces_;
    bool are_vertices_;
};

}  // namespace skinglow::detail
