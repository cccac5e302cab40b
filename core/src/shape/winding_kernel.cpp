// Winding numbers of several points at once. Highway compiles this file once for each instruction set.
#include "numerics/vector_targets.h"

// This order, since foreach_target.h reads the whole file anew for each instruction set.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shape/winding_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "shape/winding_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, PointCluster::capacity>;
constexpr Tag d;
using V = hn::Vec<Tag>;

struct V3 {
    V x, y, z;
};

HWY_INLINE V set(float x) {
    return hn::Set(d, x);
}
HWY_INLINE V dot(const V3& a, const V3& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// From the points at `i` to a point.
HWY_INLINE V3 to(const glm::vec3& point, const PointCluster& points, std::size_t i) {
    return {hn::Sub(set(point.x), hn::Load(d, &points.x[i])),
            hn::Sub(set(point.y), hn::Load(d, &points.y[i])),
            hn::Sub(set(point.z), hn::Load(d, &points.z[i]))};
}

HWY_INLINE void add(PointCluster& points, std::size_t i, V value) {
    hn::Store(hn::Add(hn::Load(d, &points.winding[i]), value), d, &points.winding[i]);
}

/// As quick_angle (triangle_tree.cpp), without its branches.
HWY_INLINE V angle(V y, V x) {
    const V ax = hn::Abs(x);
    const V ay = hn::Abs(y);
    const V r = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), set(1e-37F)));
    const V s = hn::Mul(r, r);
    V series = hn::MulAdd(set(-0.0464964749F), s, set(0.15931422F));
    series = hn::MulAdd(series, s, set(-0.327622764F));
    V result = hn::MulAdd(hn::Mul(series, s), r, r);
    result = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(set(0.5F * std::numbers::pi_v<float>), result), result);
    result = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(set(std::numbers::pi_v<float>), result), result);
    return hn::CopySignToAbs(result, y);
}

}  // namespace

void sum_windings_of(std::span<const TriangleNode> nodes, std::span<const std::array<glm::vec3, 3>> corners,
                     PointCluster& points) {
    const std::size_t lanes = hn::Lanes(d);
    points.winding.fill(0.0F);
    for (std::size_t n = 0; n < nodes.size();) {
        const TriangleNode& node = nodes[n];
        const glm::vec3 off = node.center - points.center;
        const float nearest = std::sqrt(glm::dot(off, off)) - points.radius;
        if (nearest > 0 && nearest * nearest > node.far_sq) {
            const V3 dipole{set(node.dipole.x), set(node.dipole.y), set(node.dipole.z)};
            for (std::size_t i = 0; i < points.count; i += lanes) {
                const V3 away = to(node.center, points, i);
                const V distance_sq = dot(away, away);
                add(points, i, hn::Div(dot(dipole, away), hn::Mul(distance_sq, hn::Sqrt(distance_sq))));
            }
            n = node.skip;
            continue;
        }
        for (std::uint32_t k = node.begin; node.is_leaf && k < node.end; ++k) {
            for (std::size_t i = 0; i < points.count; i += lanes) {
                const V3 a = to(corners[k][0], points, i);
                const V3 b = to(corners[k][1], points, i);
                const V3 c = to(corners[k][2], points, i);
                const V la = hn::Sqrt(dot(a, a));
                const V lb = hn::Sqrt(dot(b, b));
                const V lc = hn::Sqrt(dot(c, c));
                const V below =
                    hn::MulAdd(hn::Mul(la, lb), lc,
                               hn::MulAdd(dot(a, b), lc, hn::MulAdd(dot(b, c), la, hn::Mul(dot(c, a), lb))));
                const V half = angle(dot(a, cross(b, c)), below);
                add(points, i, hn::Mul(half, set(0.5F * std::numbers::inv_pi_v<float>)));
            }
        }
        ++n;
    }
}

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinglow::detail {

HWY_EXPORT(sum_windings_of);

PointCluster::PointCluster(std::span<const glm::vec3> points) : count(points.size()) {
    glm::vec3 low = points.front();
    glm::vec3 high = points.front();
    for (const glm::vec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    center = 0.5F * (low + high);
    // Those that fill the last vector up are the last point again.
    for (std::size_t i = 0; i < capacity; ++i) {
        const glm::vec3& p = points[std::min(i, count - 1)];
        radius = std::max(radius, glm::length(p - center));
        x[i] = p.x;
        y[i] = p.y;
        z[i] = p.z;
    }
}

void sum_windings(std::span<const TriangleNode> nodes, std::span<const std::array<glm::vec3, 3>> corners,
                  PointCluster& points) {
    HWY_DYNAMIC_DISPATCH(sum_windings_of)(nodes, corners, points);
}

}  // namespace skinglow::detail
#endif
