// Vectors of doubles, triples of them, and what the light kernels take and give.
// Included once for each instruction set, which is what this guard allows (Highway's idiom).
#if defined(SKINGLOW_RADIOMETRY_KERNEL_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SKINGLOW_RADIOMETRY_KERNEL_VECTORS_INL_H
#undef SKINGLOW_RADIOMETRY_KERNEL_VECTORS_INL_H
#else
#define SKINGLOW_RADIOMETRY_KERNEL_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <glm/vec3.hpp>
#include <numbers>

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

}  // namespace skinglow::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
