#include "tiles/plane_chart.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "geometry/edge_twins.h"
#include "geometry/vector.h"

namespace skinglow::detail {
namespace {

/// Faces of one chart deviate from its plane by at most 40 degrees: texels are up to 1.3 times as far apart.
constexpr double min_cosine = 0.766;

glm::dmat3 frame_of(const FaceList& faces, std::uint32_t face) {
    glm::dvec3 longest(0.0);
    for (std::uint32_t k = 0; k < faces.size(face); ++k) {
        const glm::dvec3 edge = faces.edge(face, k);
        if (glm::dot(edge, edge) > glm::dot(longest, longest)) longest = edge;
    }
    const glm::dvec3& normal = faces.normal(face);
    if (normal != glm::dvec3(0.0)) return frame_around(normal, longest);
    // Without area any plane along its edge serves.
    if (longest == glm::dvec3(0.0)) return glm::dmat3(1.0);
    const glm::dmat3 along = frame_around(unit(longest));
    return {along[2], along[0], along[1]};
}

}  // namespace

PlaneChart::PlaneChart(const FaceList& faces, std::uint32_t face)
    : frame_(frame_of(faces, face)),
      min_(std::numeric_limits<double>::infinity()),
      max_(-std::numeric_limits<double>::infinity()) {
    add(faces, face, std::numeric_limits<double>::infinity());
}

glm::dvec2 PlaneChart::project(const glm::dvec3& point) const {
    return {glm::dot(frame_[0], point), glm::dot(frame_[1], point)};
}

bool PlaneChart::add(const FaceList& faces, std::uint32_t face, double max_extent) {
    glm::dvec2 low = min_;
    glm::dvec2 high = max_;
    for (std::uint32_t c = faces.begin()[face]; c < faces.begin()[face + 1]; ++c) {
        const glm::dvec2 p = project(faces.point(c));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    if (high.x - low.x > max_extent || high.y - low.y > max_extent) return false;
    min_ = low;
    max_ = high;
    return true;
}

std::vector<std::uint32_t> faces_about(const FaceList& faces, std::span<const std::uint32_t> twins,
                                       std::span<const std::uint32_t> face_of_corner, std::uint32_t first,
                                       double max_extent, std::vector<std::uint8_t>& available,
                                       PlaneChart& chart) {
    std::vector<std::uint32_t> found = {first};
    available[first] = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::uint32_t c = faces.begin()[found[i]]; c < faces.begin()[found[i] + 1]; ++c) {
            if (twins[c] == no_twin) continue;
            const std::uint32_t next = face_of_corner[twins[c]];
            if (available[next] == 0 || glm::dot(faces.normal(next), chart.normal()) < min_cosine) continue;
            if (!chart.add(faces, next, max_extent)) continue;
            available[next] = 0;
            found.push_back(next);
        }
    }
    return found;
}

}  // namespace skinglow::detail
