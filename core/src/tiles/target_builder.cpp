#include "tiles/target_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "geometry/vector.h"
#include "geometry/weld.h"

namespace skinglow::detail {
namespace {

/// Texels that no triangle covers continue the nearest one by at most this many texels of the mean size: a small
/// triangle that is bent away says little about what is far from it.
constexpr double max_extension = 2;
/// Texels on one edge that are nearer, in texels, are at one point of it.
constexpr double same_point = 0.05;

/// Of the triangles at each vertex, weighted by area; 0 where they cancel out.
std::vector<glm::dvec3> vertex_normals(const MeshView& mesh, const UnitBox& to_unit, const Weld& welded) {
    std::vector<glm::dvec3> normals(welded.first.size(), glm::dvec3(0.0));
    for (const glm::uvec3& t : mesh.triangles()) {
        const glm::dvec3 a = to_unit(mesh.vertices()[t.x]);
        const glm::dvec3 area =
            glm::cross(to_unit(mesh.vertices()[t.y]) - a, to_unit(mesh.vertices()[t.z]) - a);
        for (int k = 0; k < 3; ++k) normals[welded.index[t[k]]] += area;
    }
    for (glm::dvec3& n : normals) {
        if (n != glm::dvec3(0.0)) n = unit(n);
    }
    return normals;
}

}  // namespace

TargetBuilder::TargetBuilder(const MeshView& mesh, const UnitBox& to_unit, std::size_t texels,
                             double texel_size)
    : mesh_(mesh),
      to_unit_(to_unit),
      max_extension_(max_extension * texel_size),
      welded_(weld(mesh.vertices())),
      normals_(vertex_normals(mesh, to_unit, welded_)),
      of_vertex_(welded_.first.size(), none),
      heads_(std::bit_ceil(texels + 1), none) {
    targets_.points.reserve(texels);
    targets_.normals.reserve(texels);
    targets_.corners.reserve(texels);
    targets_.weights.reserve(texels);
    on_edges_.reserve(texels);
}

std::int32_t TargetBuilder::within(const glm::uvec3& corners, const TexelTriangle& triangle,
                                   const glm::dvec2& texel) {
    const glm::dvec3 weights = triangle.snapped(texel);
    int zeros = 0;
    int zero = 0;
    int largest = 0;
    for (int k = 0; k < 3; ++k) {
        if (weights[k] > weights[largest]) largest = k;
        if (weights[k] != 0) continue;
        zero = k;
        ++zeros;
    }
    if (zeros == 0) return add(corners, weights);
    if (zeros == 2) {
        std::int32_t& target = of_vertex_[welded_.index[corners[largest]]];
        if (target == none) target = add(corners, weights);
        return target;
    }
    int from = (zero + 1) % 3;
    int to = (zero + 2) % 3;
    // From the same end for both triangles of the edge.
    if (welded_.index[corners[from]] > welded_.index[corners[to]]) std::swap(from, to);
    const std::uint32_t low = welded_.index[corners[from]];
    const std::uint32_t high = welded_.index[corners[to]];
    std::int32_t& head = heads_[hash_of(glm::dvec2(low, high)) & (heads_.size() - 1)];
    const double tolerance = same_point / triangle.edge_length(zero);
    for (std::int32_t i = head; i != none;) {
        const OnEdge& other = on_edges_[static_cast<std::size_t>(i)];
        if (other.low == low && other.high == high && std::abs(other.fraction - weights[to]) < tolerance)
            return other.target;
        i = other.next;
    }
    const std::int32_t target = add(corners, weights);
    on_edges_.push_back({low, high, weights[to], target, head});
    head = static_cast<std::int32_t>(on_edges_.size() - 1);
    return target;
}

std::int32_t TargetBuilder::beyond(const glm::uvec3& corners, const TexelTriangle& triangle,
                                   const glm::dvec2& texel) {
    const glm::dvec3 weights = triangle.weights(texel);
    const glm::dvec3 nearest = triangle.nearest(texel);
    const glm::dvec3 extension = weights - nearest;
    glm::dvec3 offset(0.0);
    for (int k = 0; k < 3; ++k) offset += extension[k] * to_unit_(mesh_.vertices()[corners[k]]);
    const double distance = glm::length(offset);
    return add(corners,
               distance > max_extension_ ? nearest + extension * (max_extension_ / distance) : weights);
}

std::int32_t TargetBuilder::add(const glm::uvec3& corners, const glm::dvec3& weights) {
    glm::dvec3 point(0.0);
    glm::dvec3 normal(0.0);
    for (int k = 0; k < 3; ++k) {
        point += weights[k] * mesh_.vertices()[corners[k]];
        normal += std::max(weights[k], 0.0) * normals_[welded_.index[corners[k]]];
    }
    targets_.points.push_back(point);
    targets_.normals.push_back(glm::dot(normal, normal) > 1e-6 ? unit(normal) : glm::dvec3(0.0));
    targets_.corners.push_back(corners);
    targets_.weights.push_back(weights);
    return static_cast<std::int32_t>(targets_.points.size() - 1);
}

}  // namespace skinglow::detail
