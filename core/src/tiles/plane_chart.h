#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "tiles/face_list.h"

namespace skinglow::detail {

/// A plane that faces are projected on.
class PlaneChart {
  public:
    /// The plane of a face, with x along its longest edge.
    PlaneChart(const FaceList& faces, std::uint32_t face);

    glm::dvec2 project(const glm::dvec3& point) const;
    const glm::dvec3& normal() const { return frame_[2]; }
    const glm::dvec2& min() const { return min_; }
    glm::dvec2 extent() const { return max_ - min_; }

    /// Widens the chart by a face, unless an extent would get larger than allowed.
    bool add(const FaceList& faces, std::uint32_t face, double max_extent);

  private:
    glm::dmat3 frame_;
    glm::dvec2 min_;
    glm::dvec2 max_;
};

/// Faces connected with the first, itself included, that face as it does and lie in a square of max_extent with it.
/// @param twins      of edge_twins
/// @param available  one per face; cleared for those that were found
std::vector<std::uint32_t> faces_about(const FaceList& faces, std::span<const std::uint32_t> twins,
                                       std::span<const std::uint32_t> face_of_corner, std::uint32_t first,
                                       double max_extent, std::vector<std::uint8_t>& available,
                                       PlaneChart& chart);

}  // namespace skinglow::detail
