// Vectors of doubles, what the light kernels take and give, and the irradiance of a rectangle without a spread, by
// J. H. Lambert's polygon formula. No guard: irradiance_kernels.cpp includes it once for each instruction set.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <glm/vec3.hpp>
#include <numbers>

#include "radiometry/irradiance_sum.h"

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<double> d;
using V = hn::Vec<decltype(d)>;
using M = hn::Mask<decltype(d)>;
using std::numbers::pi;

HWY_INLINE V set(double value) {
    return hn::Set(d, value);
}
HWY_INLINE V zero() {
    return hn::Zero(d);
}
HWY_INLINE M none_of() {
    return hn::Not(hn::Eq(zero(), zero()));
}
HWY_INLINE V positive(V v) {
    return hn::Max(v, zero());
}

struct V3 {
    V x, y, z;
};
HWY_INLINE V3 set(const glm::dvec3& v) {
    return {set(v.x), set(v.y), set(v.z)};
}
HWY_INLINE V dot(V3 a, V3 b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
HWY_INLINE V3 sub(V3 a, V3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

struct Receivers {
    V3 point;
    V3 normal;  ///< unit, or 0
};

struct Irradiance {
    V value;    ///< per unit of power
    V cosine;   ///< between the normal and the light's center
    M special;  ///< PreparedLight has to be asked
};

/// Angle between the x axis and (x, y), y >= 0 and not both 0, given y / max(|x|, 1e-17 y).
HWY_INLINE V angle_of(V x, V slope) {
    const V angle = hn::Atan(d, slope);
    return hn::IfThenElse(x < zero(), set(pi) - angle, angle);
}
HWY_INLINE V denominator(V x, V y) {
    return hn::Max(hn::Abs(x), y * set(1e-17));
}

/// The part of an edge above the horizon, and where it goes below or comes up.
struct EdgePart {
    V from, to;
    M goes_below, comes_up;
};

HWY_INLINE EdgePart part_above(V from, V to, V from_height, V to_height) {
    const M from_down = from_height < zero();
    const M to_down = to_height < zero();
    const M goes_below = hn::AndNot(from_down, to_down);
    const M comes_up = hn::AndNot(to_down, from_down);
    const V crossing = hn::MulAdd(to - from, from_height / (from_height - to_height), from);
    return {hn::IfThenElse(comes_up, crossing, from),
            hn::IfThenElse(goes_below, crossing, hn::IfThenElse(to_down, from, to)), goes_below, comes_up};
}

/// Lambert's term of a part of an edge whose line is at the root of `distance_sq` from the point: the angle it is
/// seen under, times the normal's component across it. One division serves both.
HWY_INLINE V edge_term(V from, V to, V distance_sq, V across) {
    const V distance = hn::Sqrt(distance_sq);
    const V x = hn::MulAdd(from, to, distance_sq);
    const V y = distance * hn::Abs(to - from);
    const V positive_x = denominator(x, y);
    const V inverse = set(1.0) / (positive_x * distance);
    return across * positive_x * inverse * angle_of(x, y * distance * inverse);
}

/// The rectangle seen from the receiver, in its own frame; z against the direction it shines to.
struct RectangleView {
    V x0, x1, y0, y1, height;
    V3 normal;

    HWY_INLINE V above_horizon(V x, V y) const { return dot(normal, {x, y, height}); }
};

HWY_INLINE V whole_rectangle(const RectangleView& v) {
    const V height_sq = v.height * v.height;
    const auto across = [&](V normal, V offset)
                            HWY_ATTR { return hn::MulSub(v.height, normal, offset * v.normal.z); };
    return edge_term(v.x0, v.x1, hn::MulAdd(v.y0, v.y0, height_sq), across(v.normal.y, v.y0)) -
           edge_term(v.x0, v.x1, hn::MulAdd(v.y1, v.y1, height_sq), across(v.normal.y, v.y1)) -
           edge_term(v.y0, v.y1, hn::MulAdd(v.x1, v.x1, height_sq), across(v.normal.x, v.x1)) +
           edge_term(v.y0, v.y1, hn::MulAdd(v.x0, v.x0, height_sq), across(v.normal.x, v.x0));
}

/// What is below the horizon is cut off; the cut is an edge of its own, between the points where the rim goes below
/// and comes up.
HWY_INLINE V cut_rectangle(const RectangleView& v) {
    const V height_sq = v.height * v.height;
    const V h00 = v.above_horizon(v.x0, v.y0);
    const V h10 = v.above_horizon(v.x1, v.y0);
    const V h11 = v.above_horizon(v.x1, v.y1);
    const V h01 = v.above_horizon(v.x0, v.y1);
    const EdgePart bottom = part_above(v.x0, v.x1, h00, h10);
    const EdgePart right = part_above(v.y0, v.y1, h10, h11);
    const EdgePart top = part_above(v.x1, v.x0, h11, h01);
    const EdgePart left = part_above(v.y1, v.y0, h01, h00);
    V3 out{zero(), zero(), v.height};
    V3 in = out;
    V sum = zero();
    const auto add = [&](const EdgePart& e, V offset, bool along_x, bool reversed) HWY_ATTR {
        const V across = hn::MulSub(v.height, along_x ? v.normal.y : v.normal.x, offset * v.normal.z);
        const V term = edge_term(e.from, e.to, hn::MulAdd(offset, offset, height_sq), across);
        sum = reversed ? sum - term : sum + term;
        out.x = hn::IfThenElse(e.goes_below, along_x ? e.to : offset, out.x);
        out.y = hn::IfThenElse(e.goes_below, along_x ? offset : e.to, out.y);
        in.x = hn::IfThenElse(e.comes_up, along_x ? e.from : offset, in.x);
        in.y = hn::IfThenElse(e.comes_up, along_x ? offset : e.from, in.y);
    };
    add(bottom, v.y0, true, false);
    add(top, v.y1, true, true);
    add(right, v.x1, false, true);
    add(left, v.x0, false, false);
    // Both points lie in the horizon's plane: their cross product is along the normal.
    const V3 step = sub(out, in);
    const V cross_z = out.x * in.y - out.y * in.x;
    const V across =
        hn::NegMulAdd(v.normal.z, cross_z, v.height * (v.normal.y * step.x - v.normal.x * step.y));
    const V x = dot(out, in);
    const V y = hn::Abs(across);
    const V angle = angle_of(x, y / denominator(x, y));
    return sum - hn::CopySignToAbs(angle, across);
}

/// J. H. Lambert's polygon formula in the light's frame, where each edge is parallel to an axis.
HWY_INLINE Irradiance rectangle(const KernelLight& light, const Receivers& r) {
    const double scale = std::max(light.half_x, light.half_y);
    const V3 to_light = sub(set(light.position), r.point);
    const V3 x_axis = set(light.x_axis);
    const V3 y_axis = set(light.y_axis);
    const V3 z_axis = set(light.reverse_axis);
    const V x = dot(to_light, x_axis);
    const V y = dot(to_light, y_axis);
    const V height = dot(to_light, z_axis);
    const V half_x = set(light.half_x);
    const V half_y = set(light.half_y);
    const RectangleView v{x - half_x, x + half_x,
                          y - half_y, y + half_y,
                          height,     {dot(r.normal, x_axis), dot(r.normal, y_axis), dot(r.normal, z_axis)}};
    const V center = v.above_horizon(x, y);
    const V extent = hn::MulAdd(hn::Abs(v.normal.x), half_x, hn::Abs(v.normal.y) * half_y);
    // Rounding may not hide a cut: the heights of the corners are computed by another formula.
    const V margin = extent + set(1e-12) * (hn::Abs(x) + hn::Abs(y) + hn::Abs(height));
    const M lit = hn::And(height >= zero(), center >= hn::Neg(margin));
    if (hn::AllFalse(d, lit)) return {zero(), zero(), lit};
    // Neighbors on a mesh mostly agree: all see the whole light.
    const bool is_cut = !hn::AllFalse(d, hn::And(lit, center <= margin));
    const V sum = positive(is_cut ? cut_rectangle(v) : whole_rectangle(v));
    const V distance_sq = dot(to_light, to_light);
    const M too_near = height < set(min_light_distance + 1e-9 * scale);
    const M point_like = distance_sq > set(4e8 * scale * scale);
    return {hn::IfThenElseZero(lit, sum * set(0.125 / (pi * light.half_x * light.half_y))), zero(),
            hn::And(lit, hn::Or(too_near, point_like))};
}

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
