#include "tiles/face_list.h"

#include <skinglow/box.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "numerics/argument_check.h"
#include "tiles/unit_box.h"

namespace skinglow::detail {
namespace {

void check(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> face_sizes,
           std::span<const std::uint32_t> corners) {
    for (std::size_t i = 0; i < vertices.size(); ++i) require_finite(entry_name("vertices", i), vertices[i]);
    std::size_t total = 0;
    for (std::size_t i = 0; i < face_sizes.size(); ++i) {
        require(entry_name("face_sizes", i), face_sizes[i], face_sizes[i] >= 3, "3 or more");
        total += face_sizes[i];
    }
    require("number of corners", corners.size(), corners.size() < std::numeric_limits<std::int32_t>::max(),
            "below 2^31");
    if (total != corners.size()) {
        refuse_argument("corners", std::to_string(corners.size()) + " entries",
                        std::to_string(total) + ", the sum of face_sizes");
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        require(entry_name("corners", i), corners[i], corners[i] < vertices.size(),
                "below the number of vertices");
    }
}

}  // namespace

FaceList::FaceList(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> face_sizes,
                   std::span<const std::uint32_t> corners)
    : corners_(corners), vertices_(vertices.size()) {
    check(vertices, face_sizes, corners);
    begin_.reserve(face_sizes.size() + 1);
    begin_.push_back(0);
    for (const std::uint32_t size : face_sizes) begin_.push_back(begin_.back() + size);
    if (corners.empty()) return;
    // Of what faces use: a stray vertex far off must not cost precision.
    Box box{vertices[corners[0]], vertices[corners[0]]};
    for (const std::uint32_t v : corners) {
        box.min = glm::min(box.min, vertices[v]);
        box.max = glm::max(box.max, vertices[v]);
    }
    const UnitBox to_unit(box);
    scale_ = to_unit.scale();
    points_.reserve(vertices.size());
    for (const glm::dvec3& v : vertices) points_.push_back(to_unit(v));
    longest_.resize(face_sizes.size());
    areas_.resize(face_sizes.size());
    normals_.resize(face_sizes.size());
    for (std::uint32_t face = 0; face < face_sizes.size(); ++face) add_face(face);
}

glm::dvec3 FaceList::edge(std::uint32_t face, std::uint32_t k) const {
    return point(begin_[face] + (k + 1) % size(face)) - point(begin_[face] + k);
}

void FaceList::add_face(std::uint32_t face) {
    const glm::dvec3& origin = point(begin_[face]);
    glm::dvec3 area(0.0);
    double longest_sq = 0;
    for (std::uint32_t k = 0; k < size(face); ++k) {
        const glm::dvec3 side = edge(face, k);
        longest_sq = std::max(longest_sq, glm::dot(side, side));
        area += glm::cross(point(begin_[face] + k) - origin, side);
    }
    constexpr double min_area = 1e-12;  // relative to the squared longest edge: less is rounding
    const double size = glm::length(area);
    longest_[face] = std::sqrt(longest_sq);
    areas_[face] = 0.5 * size;
    normals_[face] = size > min_area * longest_sq ? area / size : glm::dvec3(0.0);
}

}  // namespace skinglow::detail
