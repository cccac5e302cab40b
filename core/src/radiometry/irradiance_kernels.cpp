// Irradiance of one light at several points at once. Highway compiles this file once for each instruction set.
#include "numerics/vector_targets.h"

// This order, since foreach_target.h reads the whole file anew for each instruction set.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiometry/irradiance_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>

#include "radiometry/irradiance_sum.h"

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<double> d;
using V = hn::Vec<decltype(d)>;
using M = hn::Mask<decltype(d)>;
constexpr double pi = std::numbers::pi;

HWY_INLINE V set(double value) {
    return hn::Set(d, value);
}
HWY_INLINE V zero() {
    return hn::Zero(d);
}
HWY_INLINE M nowhere() {
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

HWY_INLINE Irradiance sun(const KernelLight& light, const Receivers& r) {
    const V cosine = dot(r.normal, set(light.reverse_axis));
    const bool is_disk = light.sin_sun_radius > 0.0;
    return {positive(cosine), cosine, is_disk ? hn::Abs(cosine) < set(light.sin_sun_radius) : nowhere()};
}

/// A lit ball, or the point it shrinks to; a spot's is multiplied by its profile.
HWY_INLINE Irradiance ball(const KernelLight& light, const Receivers& r, bool is_spot) {
    const V3 to_light = sub(set(light.position), r.point);
    const V radius_sq = set(light.radius_sq);
    const V distance_sq = dot(to_light, to_light);
    const V softened_sq = distance_sq + set(light.softening_sq);
    const V towards = dot(to_light, r.normal);
    const V inverse = set(1.0) / (hn::Sqrt(distance_sq) * softened_sq);  // one division for all
    const V inverse_distance = inverse * softened_sq;
    const V value = positive(towards) * set(0.25 / pi) * inverse;
    const V cosine = towards * inverse_distance;
    const bool has_size = light.radius_sq > 0.0;
    M special = distance_sq < set(light.min_distance_sq);
    if (has_size) special = hn::Or(special, towards * towards * softened_sq < radius_sq * distance_sq);
    if (!is_spot) return {value, cosine, special};

    const V cos_axis = dot(to_light, set(light.reverse_axis)) * inverse_distance;
    const V from_edge = cos_axis - set(light.cos_edge);
    const V t = hn::Min(positive(from_edge * set(light.fade_scale)), set(1.0));
    const V falloff = hn::MulAdd(set(light.cosine_falloff), cos_axis - set(1.0), set(1.0));
    const V profile = t * t * hn::NegMulAdd(set(2.0), t, set(3.0)) * falloff;
    if (has_size) {
        // Within the light's angular radius (at most pi/2 times its sine, that at most r/d) the profile is not
        // constant.
        const V margin = set(light.half_pi_radius) * inverse_distance;
        const M may_be_lit = from_edge > hn::Neg(margin);
        const M uneven = hn::And(margin > set(2e-6), cos_axis < set(light.cos_uneven) + margin);
        const M inside = distance_sq < radius_sq + set(min_light_distance * min_light_distance);
        special = hn::Or(hn::And(may_be_lit, hn::Or(special, uneven)), hn::AndNot(may_be_lit, inside));
    }
    return {value * profile, cosine, special};
}

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
    // Rounding may not hide a cut: the heights of the corners are worked out in another way.
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

HWY_INLINE Irradiance irradiance_of(const KernelLight& light, const Receivers& r) {
    switch (light.kernel) {
        case KernelLight::Kernel::sun:
            return sun(light, r);
        case KernelLight::Kernel::point:
            return ball(light, r, false);
        case KernelLight::Kernel::spot:
            return ball(light, r, true);
        case KernelLight::Kernel::rectangle:
            return rectangle(light, r);
        case KernelLight::Kernel::none:
            break;
    }
    return {zero(), zero(), hn::Not(nowhere())};
}

using Lanes = std::array<double, HWY_MAX_BYTES / sizeof(double)>;

/// Adds a light point by point, where angles count or one of the points is special.
HWY_NOINLINE void add_lanes(const IrradianceSum& sum, const KernelLight& light, const glm::dvec3* points,
                            const glm::dvec3* unit_normals, std::size_t count, const Irradiance& e,
                            glm::dvec3* sums) {
    Lanes value;
    Lanes cosine;
    const V unknown = set(std::numeric_limits<double>::quiet_NaN());
    hn::StoreU(hn::IfThenElse(e.special, unknown, e.value), d, value.data());
    hn::StoreU(hn::IfThenElse(e.special, unknown, e.cosine), d, cosine.data());
    for (std::size_t i = 0; i < count; ++i)
        sum.add_one(light, points[i], unit_normals[i], value[i], cosine[i], sums[i]);
}

/// `count` points, at most as many as a vector has lanes; all arrays are as long as a vector.
HWY_INLINE void add_vector(const IrradianceSum& sum, std::span<const KernelLight> lights,
                           const glm::dvec3* points, const glm::dvec3* normals, std::size_t count,
                           glm::dvec3* sums) {
    Receivers r;
    hn::LoadInterleaved3(d, &points->x, r.point.x, r.point.y, r.point.z);
    hn::LoadInterleaved3(d, &normals->x, r.normal.x, r.normal.y, r.normal.z);
    const auto largest = [](V3 v)
                             HWY_ATTR { return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); };
    const V longest = largest(r.normal);
    const M usual_normal = hn::Or(longest == zero(), hn::And(longest > set(1e-140), longest < set(1e140)));
    const auto below = [](V3 v, double limit) HWY_ATTR {
        // Not by the largest: Max may drop a NaN.
        return hn::And(hn::Abs(v.x) < set(limit),
                       hn::And(hn::Abs(v.y) < set(limit), hn::Abs(v.z) < set(limit)));
    };
    if (!hn::AllTrue(d, hn::And(hn::And(usual_normal, below(r.normal, 1e140)), below(r.point, 1e70)))) {
        for (std::size_t i = 0; i < count; ++i) sum.add_one_by_one(lights, points[i], normals[i], sums[i]);
        return;
    }
    const V scale = set(1.0) / hn::Sqrt(hn::Max(dot(r.normal, r.normal), set(1e-300)));
    r.normal = {r.normal.x * scale, r.normal.y * scale, r.normal.z * scale};
    std::array<glm::dvec3, std::tuple_size_v<Lanes>> unit_normals;
    hn::StoreInterleaved3(r.normal.x, r.normal.y, r.normal.z, d, &unit_normals[0].x);

    V3 total{zero(), zero(), zero()};
    const KernelLight* light = lights.data();
    const KernelLight* const end = light + lights.size();
    for (; light != end; ++light) {
        Irradiance e{zero(), zero(), nowhere()};
        // A loop of its own, without calls, so that the totals stay in registers.
        for (; light != end; ++light) {
            e = irradiance_of(*light, r);
            if (sum.has_angular_weight() || !hn::AllFalse(d, e.special)) break;
            total.x = hn::MulAdd(set(light->strength.r), e.value, total.x);
            total.y = hn::MulAdd(set(light->strength.g), e.value, total.y);
            total.z = hn::MulAdd(set(light->strength.b), e.value, total.z);
        }
        if (light == end) break;
        add_lanes(sum, *light, points, unit_normals.data(), count, e, sums);
    }
    V3 before;
    hn::LoadInterleaved3(d, &sums->x, before.x, before.y, before.z);
    hn::StoreInterleaved3(before.x + total.x, before.y + total.y, before.z + total.z, d, &sums->x);
}

void add_irradiance(const IrradianceSum& sum, std::span<const glm::dvec3> points,
                    std::span<const glm::dvec3> normals, std::span<glm::dvec3> sums) {
    constexpr std::size_t lights_at_once = 64;  // their numbers stay in the first-level cache
    const std::size_t lanes = hn::Lanes(d);
    std::span<const KernelLight> rest = sum.lights();
    do {  // once without lights too: what is not finite has to show
        const std::span<const KernelLight> lights = rest.first(std::min(rest.size(), lights_at_once));
        rest = rest.subspan(lights.size());
        std::size_t i = 0;
        for (; i + lanes <= points.size(); i += lanes)
            add_vector(sum, lights, &points[i], &normals[i], lanes, &sums[i]);
        if (i == points.size()) continue;
        std::array<std::array<glm::dvec3, std::tuple_size_v<Lanes>>, 3> last{};
        const std::size_t count = points.size() - i;
        std::copy_n(&points[i], count, last[0].begin());
        std::copy_n(&normals[i], count, last[1].begin());
        std::copy_n(&sums[i], count, last[2].begin());
        add_vector(sum, lights, last[0].data(), last[1].data(), count, last[2].data());
        std::copy_n(last[2].begin(), count, &sums[i]);
    } while (!rest.empty());
}

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinglow::detail {

HWY_EXPORT(add_irradiance);

void IrradianceSum::add(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                        std::span<glm::dvec3> sums) const {
    HWY_DYNAMIC_DISPATCH(add_irradiance)(*this, points, normals, sums);
}

}  // namespace skinglow::detail
#endif
