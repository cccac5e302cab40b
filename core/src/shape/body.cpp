#include "shape/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "geometry/vector.h"
#include "geometry/weld.h"
#include "numerics/argument_check.h"
#include "numerics/job.h"
#include "shape/face_orientation.h"

namespace skinglow::detail {
namespace {

/// Ten kilometers: single precision has a millimeter left there.
constexpr double max_radius_mm = 1e7;
/// Of the curvature, each over an edge: what is smaller than a mean free path of light does not count.
constexpr int smoothings = 3;

/// The corners with the least first, in the order of the winding; and whether the winding is that of the
/// sorted corners, which tells a triangle from its mirror image.
struct TriangleKey {
    glm::uvec3 sorted;
    bool is_even;
};

TriangleKey key_of(const glm::uvec3& corners) {
    glm::uvec3 c = corners;
    bool is_even = true;
    const auto order = [&](int a, int b) {
        if (c[a] <= c[b]) return;
        std::swap(c[a], c[b]);
        is_even = !is_even;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return {c, is_even};
}

/// Which triangles stay: of those on the same corners one, and none where as many face either way.
std::vector<bool> kept_once(std::span<const BodyTriangle> triangles) {
    struct Entry {
        TriangleKey key;
        std::uint32_t index;
    };
    std::vector<Entry> entries(triangles.size());
    for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i] = {key_of(triangles[i].welded), i};
    const auto tuple = [](const Entry& e) {
        return std::array{e.key.sorted.x, e.key.sorted.y, e.key.sorted.z, e.index};
    };
    std::sort(entries.begin(), entries.end(),
              [&](const Entry& a, const Entry& b) { return tuple(a) < tuple(b); });
    std::vector<bool> kept(triangles.size(), false);
    for (std::size_t i = 0; i < entries.size();) {
        std::size_t end = i;
        int sum = 0;
        for (; end < entries.size() && entries[end].key.sorted == entries[i].key.sorted; ++end)
            sum += entries[end].key.is_even ? 1 : -1;
        for (std::size_t k = i; k < end && sum != 0; ++k) {
            if (entries[k].key.is_even != (sum > 0)) continue;
            kept[entries[k].index] = true;
            break;
        }
        i = end;
    }
    return kept;
}

}  // namespace

Body::Body(const MeshView& mesh, double unit_mm) : unit_mm_(unit_mm) {
    const auto given = mesh.vertices();
    const auto box = box_of(std::span(&mesh, 1));
    if (box) origin_ = box->center();
    if (box && !(box->radius() * unit_mm <= max_radius_mm)) {
        refuse_argument("vertices", to_text(box->radius() * unit_mm) + " mm from their center",
                        "up to 1e7 mm: is unit_mm right?");
    }
    Weld weld = detail::weld(given);
    positions_.reserve(weld.first.size());
    for (const std::uint32_t first : weld.first) positions_.push_back(local(given[first]));
    welded_of_ = std::move(weld.index);
    settle_loose_vertices(mesh.triangles());
    stop_if_asked();
    add_triangles(mesh.triangles());
    stop_if_asked();
    turn_outward();
    stop_if_asked();
    index_triangles();
    stop_if_asked();
    find_curvature();
}

void Body::settle_loose_vertices(std::span<const glm::uvec3> triangles) {
    std::vector<bool> is_used(positions_.size(), false);
    for (const glm::uvec3& t : triangles) {
        for (int k = 0; k < 3; ++k) is_used[welded_of_[t[k]]] = true;
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        if (!is_used[i]) positions_[i] = glm::vec3(0.0F);
    }
}

void Body::add_triangles(std::span<const glm::uvec3> triangles) {
    std::vector<BodyTriangle> all;
    all.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        stop_if_asked(all.size());
        const glm::uvec3 welded(welded_of_[t.x], welded_of_[t.y], welded_of_[t.z]);
        const glm::dvec3 a = positions_[welded.x];
        const glm::dvec3 b = positions_[welded.y];
        const glm::dvec3 c = positions_[welded.z];
        const glm::dvec3 normal = triangle_normal(a, b, c);
        const auto area = static_cast<float>(0.5 * length(glm::cross(b - a, c - a)));
        if (normal == glm::dvec3(0.0) || !(area > 0)) continue;
        all.push_back({t, welded, normal, area});
    }
    stop_if_asked();
    const std::vector<bool> kept = kept_once(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (kept[i]) triangles_.push_back(all[i]);
    }
}

void Body::turn_outward() {
    const auto turn = [](BodyTriangle& t) {
        std::swap(t.corners.y, t.corners.z);
        std::swap(t.welded.y, t.welded.z);
        t.normal = -t.normal;
    };
    const std::vector<bool> against = against_neighbors(triangles_);
    double volume = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        BodyTriangle& t = triangles_[i];
        if (against[i]) turn(t);
        volume += static_cast<double>(t.area) * glm::dot(glm::dvec3(t.normal), glm::dvec3(corner(t, 0)));
    }
    if (volume >= 0) return;
    for (BodyTriangle& t : triangles_) turn(t);
}

void Body::index_triangles() {
    begin_.assign(positions_.size() + 1, 0);
    for (const BodyTriangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) ++begin_[t.welded[k] + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    at_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        for (int k = 0; k < 3; ++k) at_[next[triangles_[i].welded[k]]++] = i;
    }
}

/// By how much the normals of an edge's ends turn along it, over its length: the mean over edges in all directions is
/// the mean curvature.
void Body::find_curvature() {
    std::vector<glm::vec3> normals(positions_.size(), glm::vec3(0.0F));
    for (const BodyTriangle& t : triangles_) {
        for (int k = 0; k < 3; ++k) normals[t.welded[k]] += t.normal * t.area;
    }
    for (glm::vec3& n : normals) n /= std::max(glm::length(n), std::numeric_limits<float>::min());
    const auto mean_over_edges = [&](const auto& of_edge) {
        std::vector<float> sum(positions_.size(), 0.0F);
        std::vector<float> count(positions_.size(), 0.0F);
        for (const BodyTriangle& t : triangles_) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = t.welded[k];
                const std::uint32_t b = t.welded[(k + 1) % 3];
                const auto [at_a, at_b] = of_edge(a, b);
                sum[a] += at_a;
                sum[b] += at_b;
                ++count[a];
                ++count[b];
            }
        }
        for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(1.0F, count[v]);
        return sum;
    };
    curvature_ = mean_over_edges([&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3 edge = positions_[b] - positions_[a];
        const float turn = glm::dot(normals[b] - normals[a], edge) / std::max(glm::dot(edge, edge), 1e-12F);
        return std::pair(turn, turn);
    });
    for (int i = 0; i < smoothings; ++i) {
        curvature_ = mean_over_edges([&](std::uint32_t a, std::uint32_t b) {
            const float both = 0.5F * (curvature_[a] + curvature_[b]);
            return std::pair(both, both);
        });
    }
}

}  // namespace skinglow::detail
