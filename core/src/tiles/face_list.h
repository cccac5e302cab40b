#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Checked faces of any number of corners, moved to the origin and scaled to the unit box, so that no square of
/// a length over- or underflows.
class FaceList {
  public:
    /// Parameters and errors as FaceTiles.
    FaceList(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> face_sizes,
             std::span<const std::uint32_t> corners);

    std::size_t faces() const { return normals_.size(); }
    std::size_t vertices() const { return vertices_; }
    std::span<const std::uint32_t> corners() const { return corners_; }
    /// First corner of each face, and the number of corners.
    const std::vector<std::uint32_t>& begin() const { return begin_; }
    std::uint32_t size(std::uint32_t face) const { return begin_[face + 1] - begin_[face]; }
    const glm::dvec3& point(std::uint32_t corner) const { return points_[corners_[corner]]; }
    /// From corner k of a face to the next one.
    glm::dvec3 edge(std::uint32_t face, std::uint32_t k) const;
    double longest_edge(std::uint32_t face) const { return longest_[face]; }
    double area(std::uint32_t face) const { return areas_[face]; }
    /// Unit vector by the area that the corners span; 0 for a face without area.
    const glm::dvec3& normal(std::uint32_t face) const { return normals_[face]; }
    /// Length of the unit box's edge in the units given.
    double scale() const { return scale_; }

  private:
    void add_face(std::uint32_t face);

    std::span<const std::uint32_t> corners_;
    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> begin_;
    std::vector<double> longest_;
    std::vector<double> areas_;
    std::vector<glm::dvec3> normals_;
    std::size_t vertices_ = 0;
    double scale_ = 1;
};

}  // namespace skinglow::detail
