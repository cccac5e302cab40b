// Irradiance of one light at several points at once. Highway compiles this file once for each instruction set.
#include "numerics/vector_targets.h"

// This order, since foreach_target.h reads the whole file anew for each instruction set.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiometry/irradiance_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "radiometry/rectangle_kernel-inl.h"
// clang-format on

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "radiometry/irradiance_sum.h"
#include "radiometry/spread_integral.h"

HWY_BEFORE_NAMESPACE();
namespace skinglow::detail::HWY_NAMESPACE {

HWY_INLINE Irradiance sun(const KernelLight& light, const Receivers& r) {
    const V cosine = dot(r.normal, set(light.reverse_axis));
    return {positive(cosine), cosine, hn::Abs(cosine) < set(light.sin_sun_radius)};
}

/// A sun that straddles the horizon of some points: cap_irradiance, with its small tangents alone.
HWY_INLINE Irradiance sun_in_part(const KernelLight& light, const Receivers& r) {
    const V one = set(1.0);
    const V cosine = dot(r.normal, set(light.reverse_axis));
    const V sine = hn::Sqrt(positive(hn::NegMulAdd(cosine, cosine, one)));
    const V sin_radius = set(light.sin_sun_radius);
    const V cos_radius = hn::Sqrt(one - sin_radius * sin_radius);
    const M in_part = hn::Abs(cosine) < sin_radius;
    const V rise = hn::Max(set(-1.0), hn::Min(hn::Neg(cos_radius * cosine) / (sin_radius * sine), one));
    const V per_radius = sine * hn::Sqrt(hn::NegMulAdd(rise, rise, one)) / cos_radius;
    const V tangent = per_radius * sin_radius;
    V series = zero();  // tangent_series
    for (const double term : {1.0 / 11, -1.0 / 9, 1.0 / 7, -1.0 / 5, 1.0 / 3})
        series = hn::MulAdd(series, tangent * tangent, set(term));
    const V rest = hn::NegMulAdd(per_radius * per_radius, series, one) * tangent;
    const V value = hn::MulAdd(cosine, hn::Acos(d, rise), rest) * set(1.0 / pi);
    return {hn::IfThenElse(in_part, positive(value), positive(cosine)), cosine,
            hn::AndNot(tangent < set(small_tangent), in_part)};
}

/// A lit ball, or the point it shrinks to; a spot's is multiplied by its profile.
HWY_INLINE Irradiance ball(const KernelLight& light, const Receivers& r, bool is_spot) {
    const V3 to_light = sub(set(light.position), r.point);
    const V radius_sq = set(light.radius_sq);
    const V distance_sq = dot(to_light, to_light);
    const V softened_sq = distance_sq + set(light.softening_sq);
    const V height = dot(to_light, r.normal);
    const V inverse = set(1.0) / (hn::Sqrt(distance_sq) * softened_sq);  // one division for all
    const V inverse_distance = inverse * softened_sq;
    const V value = positive(height) * set(0.25 / pi) * inverse;
    const V cosine = height * inverse_distance;
    const bool has_size = light.radius_sq > 0.0;
    M special = distance_sq < set(light.min_distance_sq);
    if (has_size) special = hn::Or(special, height * height * softened_sq < radius_sq * distance_sq);
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

HWY_INLINE Irradiance point(const KernelLight& light, const Receivers& r) {
    return ball(light, r, false);
}
HWY_INLINE Irradiance spot(const KernelLight& light, const Receivers& r) {
    return ball(light, r, true);
}
HWY_INLINE Irradiance none(const KernelLight& /*light*/, const Receivers& /*r*/) {
    return {zero(), zero(), hn::Not(none_of())};
}

/// Lights of one kernel, so that the choice is made once for all of them.
using Run = std::span<const KernelLight>;
using Runs = std::array<Run, 1 + static_cast<std::size_t>(KernelLight::Kernel::none)>;

using Lanes = std::array<double, HWY_MAX_BYTES / sizeof(double)>;

/// A vector of points, of which the first `count` are wanted; all arrays are as long as a vector.
struct Points {
    const IrradianceSum& sum;
    const glm::dvec3* points;
    std::size_t count;
    glm::dvec3* sums;
};

/// Adds a light point by point: at the special ones, or at all where angles count.
HWY_NOINLINE void add_lanes(const Points& p, const KernelLight& light, Irradiance e, V3 normal) {
    Lanes value;
    Lanes cosine;
    const V unknown = set(std::numeric_limits<double>::quiet_NaN());
    hn::StoreU(hn::IfThenElse(e.special, unknown, e.value), d, value.data());
    hn::StoreU(hn::IfThenElse(e.special, unknown, e.cosine), d, cosine.data());
    std::array<glm::dvec3, std::tuple_size_v<Lanes>> unit_normals;
    hn::StoreInterleaved3(normal.x, normal.y, normal.z, d, &unit_normals[0].x);
    for (std::size_t i = 0; i < p.count; ++i) {
        if (p.sum.has_angular_weight() || std::isnan(value[i]))
            p.sum.add_one(light, p.points[i], unit_normals[i], value[i], cosine[i], p.sums[i]);
    }
}

HWY_INLINE V3 plus(V3 total, const KernelLight& light, V value) {
    return {hn::MulAdd(set(light.strength.r), value, total.x),
            hn::MulAdd(set(light.strength.g), value, total.y),
            hn::MulAdd(set(light.strength.b), value, total.z)};
}

using KernelFunction = Irradiance(const KernelLight&, const Receivers&);

/// Adds lights that one kernel serves.
/// @tparam in_part  for vectors of points some of which are special to the kernel
template <KernelFunction kernel, KernelFunction in_part = kernel>
HWY_INLINE V3 add_run(V3 total, Run run, const Points& p, const Receivers& r) {
    const bool by_lane = p.sum.has_angular_weight();
    const KernelLight* light = run.data();
    const KernelLight* const end = light + run.size();
    for (; light != end; ++light) {
        // A loop without calls and without values that outlive it: all stays in registers.
        for (; light != end && !by_lane; ++light) {
            const Irradiance e = kernel(*light, r);
            if (!hn::AllFalse(d, e.special)) break;
            total = plus(total, *light, e.value);
        }
        if (light == end) break;
        const Irradiance e = in_part(*light, r);
        if (!by_lane) total = plus(total, *light, hn::IfThenZeroElse(e.special, e.value));
        if (by_lane || !hn::AllFalse(d, e.special)) add_lanes(p, *light, e, r.normal);
    }
    return total;
}

HWY_INLINE void add_vector(const IrradianceSum& sum, const Runs& runs, const glm::dvec3* points,
                           const glm::dvec3* normals, std::size_t count, glm::dvec3* sums) {
    Receivers r;
    hn::LoadInterleaved3(d, &points->x, r.point.x, r.point.y, r.point.z);
    hn::LoadInterleaved3(d, &normals->x, r.normal.x, r.normal.y, r.normal.z);
    const V size = hn::Abs(r.normal.x) + hn::Abs(r.normal.y) + hn::Abs(r.normal.z);
    const V length_sq = dot(r.normal, r.normal);
    const M usual_normal = hn::Or(size == zero(), hn::And(length_sq > set(1e-280), length_sq < set(1e280)));
    // Not so where something is not finite.
    if (!hn::AllTrue(d, hn::And(usual_normal, dot(r.point, r.point) < set(1e140)))) {
        for (std::size_t i = 0; i < count; ++i) {
            for (const Run run : runs) sum.add_one_by_one(run, points[i], normals[i], sums[i]);
        }
        return;
    }
    const V scale = set(1.0) / hn::Sqrt(hn::Max(length_sq, set(1e-300)));
    r.normal = {r.normal.x * scale, r.normal.y * scale, r.normal.z * scale};

    const Points p{sum, points, count, sums};
    const auto run = [&](KernelLight::Kernel kernel) { return runs[static_cast<std::size_t>(kernel)]; };
    V3 total{zero(), zero(), zero()};
    total = add_run<sun, sun_in_part>(total, run(KernelLight::Kernel::sun), p, r);
    total = add_run<point>(total, run(KernelLight::Kernel::point), p, r);
    total = add_run<spot>(total, run(KernelLight::Kernel::spot), p, r);
    total = add_run<rectangle>(total, run(KernelLight::Kernel::rectangle), p, r);
    total = add_run<none>(total, run(KernelLight::Kernel::none), p, r);
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
        Runs runs;
        for (const KernelLight& light : lights) {
            Run& run = runs[static_cast<std::size_t>(light.kernel)];
            run = {run.empty() ? &light : run.data(), run.size() + 1};
        }
        std::size_t i = 0;
        for (; i + lanes <= points.size(); i += lanes)
            add_vector(sum, runs, &points[i], &normals[i], lanes, &sums[i]);
        if (i == points.size()) continue;
        std::array<std::array<glm::dvec3, std::tuple_size_v<Lanes>>, 3> last{};
        const std::size_t count = points.size() - i;
        std::copy_n(&points[i], count, last[0].begin());
        std::copy_n(&normals[i], count, last[1].begin());
        std::copy_n(&sums[i], count, last[2].begin());
        add_vector(sum, runs, last[0].data(), last[1].data(), count, last[2].data());
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
