#include "radiometry/lamp_kernels.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "numerics/vector_loops.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double min_square = min_light_distance * min_light_distance;

SKINGLOW_VECTOR_CLONES
void sun_block(const PreparedLight& light, const PlaceBlock& p, BlockIrradiance& r) {
    const glm::dvec3 d = light.direction();
    const double sine = light.sin_sun_radius();
    const std::size_t count = p.count;
    const double* p_nx = p.nx.data();
    const double* p_ny = p.ny.data();
    const double* p_nz = p.nz.data();
    double* value_out = r.value.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double cosine = -(p_nx[i] * d.x + p_ny[i] * d.y + p_nz[i] * d.z);
        value_out[i] = cosine > 0.0 ? cosine : 0.0;
        special_out[i] = std::abs(cosine) < sine ? 1.0 : 0.0;
    }
}

/// The cone of a spot. For a point: one that lets everything through.
struct Cone {
    double cos_edge = -2.0;
    double per_fade = 1.0;  ///< 1 / (cosine where the fade starts - cos_edge)
    double uneven_from = 2.0;
    double with_cosine = 0.0;
};

Cone cone_of(const SpotProfile& spot) {
    const double fade = spot.cos_fade_start() - spot.cos_edge();
    return {spot.cos_edge(), fade > 0.0 ? 1.0 / fade : 1e300,
            spot.with_cosine() ? 2.0 : spot.cos_fade_start(), spot.with_cosine() ? 1.0 : 0.0};
}

/// A lit ball, or the point it shrinks to; with is_spot, times what its cone lets through.
[[gnu::always_inline]] inline void ball_loop(const PreparedLight& light, const Cone& cone,
                                             const PlaceBlock& p, BlockIrradiance& r, bool is_spot) {
    const glm::dvec3 l = light.position();
    const glm::dvec3 d = is_spot ? light.direction() : glm::dvec3(0.0);
    const double radius_square = light.radius() * light.radius();
    const double half_pi_radius = 0.5 * pi * light.radius();
    const double soft_square = light.soft_falloff() ? radius_square : 0.0;
    const double least_square = light.soft_falloff()         ? min_square
                                : radius_square > min_square ? radius_square
                                                             : min_square;
    const std::size_t count = p.count;
    const double* p_x = p.x.data();
    const double* p_y = p.y.data();
    const double* p_z = p.z.data();
    const double* p_nx = p.nx.data();
    const double* p_ny = p.ny.data();
    const double* p_nz = p.nz.data();
    double* value_out = r.value.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = l.x - p_x[i];
        const double vy = l.y - p_y[i];
        const double vz = l.z - p_z[i];
        const double square = vx * vx + vy * vy + vz * vz;
        const double reach_square = square + soft_square;
        const double towards = vx * p_nx[i] + vy * p_ny[i] + vz * p_nz[i];
        const double root = std::sqrt(square);
        const double inverse = 1.0 / (root * reach_square);  // one division for all
        const double value = (towards > 0.0 ? towards : 0.0) * (0.25 / pi) * inverse;
        const bool on_horizon = towards * towards * reach_square < radius_square * square;
        const double special = on_horizon || square < least_square ? 1.0 : 0.0;
        if (!is_spot) {
            value_out[i] = value;
            special_out[i] = special;
        } else {
            const double inverse_root = inverse * reach_square;
            const double cosine = -(vx * d.x + vy * d.y + vz * d.z) * inverse_root;
            double t = (cosine - cone.cos_edge) * cone.per_fade;
            t = t > 0.0 ? t : 0.0;
            t = t < 1.0 ? t : 1.0;
            // Within the lamp's angular radius (at most pi/2 times its sine, that at most r/d) the profile is
            // not even.
            const double margin = half_pi_radius * inverse_root;
            const bool uneven =
                margin > 2e-6 && cosine > cone.cos_edge - margin && cosine < cone.uneven_from + margin;
            const bool dark = cosine <= cone.cos_edge - margin;
            special_out[i] = uneven ? 1.0
                             : dark ? (square < radius_square + min_square ? 1.0 : 0.0)
                                    : special;
            value_out[i] = value * t * t * (3.0 - 2.0 * t) * (1.0 + cone.with_cosine * (cosine - 1.0));
        }
    }
}

SKINGLOW_VECTOR_CLONES
void point_block(const PreparedLight& light, const PlaceBlock& p, BlockIrradiance& r) {
    ball_loop(light, {}, p, r, false);
}

SKINGLOW_VECTOR_CLONES
void spot_block(const PreparedLight& light, const Cone& cone, const PlaceBlock& p, BlockIrradiance& r) {
    ball_loop(light, cone, p, r, true);
}

SKINGLOW_VECTOR_CLONES
void cosine_to_sun(const PreparedLight& light, const PlaceBlock& p, double* cosine) {
    const glm::dvec3 d = light.direction();
    const std::size_t count = p.count;
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) cosine[i] = -(p.nx[i] * d.x + p.ny[i] * d.y + p.nz[i] * d.z);
}

SKINGLOW_VECTOR_CLONES
void cosine_to_lamp(const PreparedLight& light, const PlaceBlock& p, double* cosine) {
    const glm::dvec3 l = light.position();
    const std::size_t count = p.count;
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = l.x - p.x[i];
        const double vy = l.y - p.y[i];
        const double vz = l.z - p.z[i];
        cosine[i] = (vx * p.nx[i] + vy * p.ny[i] + vz * p.nz[i]) / std::sqrt(vx * vx + vy * vy + vz * vz);
    }
}

SKINGLOW_VECTOR_CLONES
void add_strength(const BlockIrradiance& one, const glm::dvec3& strength, std::size_t count, BlockSum& sum) {
    const double* value = one.value.data();
    double* red = sum.red.data();
    double* green = sum.green.data();
    double* blue = sum.blue.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        red[i] += strength.r * value[i];
        green[i] += strength.g * value[i];
        blue[i] += strength.b * value[i];
    }
}

// Counted in whole numbers: a sum or maximum of floating-point numbers may not be taken in another order.
SKINGLOW_VECTOR_CLONES
std::int64_t count_special(const BlockIrradiance& one, std::size_t count) {
    const double* special = one.special.data();
    std::int64_t found = 0;
    for (std::size_t i = 0; i < count; ++i) found += special[i] > 0.0 ? 1 : 0;
    return found;
}

SKINGLOW_VECTOR_CLONES
std::int64_t count_beyond(const BlockValues& values, std::size_t count, double most) {
    const double* value = values.data();
    std::int64_t found = 0;
    for (std::size_t i = 0; i < count; ++i) found += std::abs(value[i]) <= most ? 0 : 1;
    return found;
}

SKINGLOW_VECTOR_CLONES
std::int64_t normalize_block(PlaceBlock& p) {
    const std::size_t count = p.count;
    double* nx = p.nx.data();
    double* ny = p.ny.data();
    double* nz = p.nz.data();
    std::int64_t odd = 0;
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double square = nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i];
        double is_odd = square < 1e-280 ? 1.0 : 0.0;
        is_odd = square > 1e280 ? 1.0 : is_odd;
        const double scale = is_odd > 0.0 ? 1.0 : 1.0 / std::sqrt(square);
        nx[i] *= scale;
        ny[i] *= scale;
        nz[i] *= scale;
        odd += is_odd > 0.0 ? 1 : 0;
    }
    return odd;
}

}  // namespace

void normalize(PlaceBlock& places) {
    if (normalize_block(places) == 0) return;
    for (std::size_t i = 0; i < places.count; ++i) {
        const glm::dvec3 given(places.nx[i], places.ny[i], places.nz[i]);
        const glm::dvec3 n = given == glm::dvec3(0.0) ? given : unit(given);
        places.nx[i] = n.x;
        places.ny[i] = n.y;
        places.nz[i] = n.z;
    }
}

bool all_within(const BlockValues& values, std::size_t count, double most) {
    return count_beyond(values, count, most) == 0;
}

bool any_special(const BlockIrradiance& one, std::size_t count) {
    return count_special(one, count) > 0;
}

void add_block(const BlockIrradiance& one, const glm::dvec3& strength, std::size_t count, BlockSum& sum) {
    add_strength(one, strength, count, sum);
}

void block_irradiance(const PreparedLight& light, const PlaceBlock& places, BlockIrradiance& result) {
    switch (light.kind()) {
        case LightKind::sun:
            return sun_block(light, places, result);
        case LightKind::point:
            return point_block(light, places, result);
        case LightKind::spot:
            return spot_block(light, cone_of(*light.spot()), places, result);
        case LightKind::area:
            break;
    }
    const AreaEmitter& area = *light.area();
    if (area.shape() == AreaShape::rectangle && !area.spreads()) {
        return rectangle_block(light, area, places, result);
    }
    result.value.fill(0.0);
    result.special.fill(1.0);
}

void block_cosine(const PreparedLight& light, const PlaceBlock& places, BlockValues& cosine) {
    if (light.kind() == LightKind::sun) return cosine_to_sun(light, places, cosine.data());
    cosine_to_lamp(light, places, cosine.data());
}

}  // namespace skinglow
