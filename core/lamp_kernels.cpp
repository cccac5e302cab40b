#include "lamp_kernels.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "vector_loops.h"

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
    double* cosine_out = r.cosine.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double cosine = -(p_nx[i] * d.x + p_ny[i] * d.y + p_nz[i] * d.z);
        cosine_out[i] = cosine;
        value_out[i] = cosine > 0.0 ? cosine : 0.0;
        special_out[i] = std::abs(cosine) < sine ? 1.0 : 0.0;
    }
}

SKINGLOW_VECTOR_CLONES
void ball_block(const PreparedLight& light, const PlaceBlock& p, BlockIrradiance& r) {
    const glm::dvec3 l = light.position();
    const double radius_square = light.radius() * light.radius();
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
    double* cosine_out = r.cosine.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = l.x - p_x[i];
        const double vy = l.y - p_y[i];
        const double vz = l.z - p_z[i];
        const double square = vx * vx + vy * vy + vz * vz;
        const double reach_square = square + soft_square;
        const double towards = vx * p_nx[i] + vy * p_ny[i] + vz * p_nz[i];
        const double inverse = 1.0 / (std::sqrt(square) * reach_square);  // one division for both
        const double cosine = towards * inverse * reach_square;
        cosine_out[i] = cosine;
        value_out[i] = (towards > 0.0 ? towards : 0.0) * (0.25 / pi) * inverse;
        const bool on_horizon = cosine * cosine * reach_square < radius_square;
        special_out[i] = on_horizon || square < least_square ? 1.0 : 0.0;
    }
}

SKINGLOW_VECTOR_CLONES
void spot_factor_block(const PreparedLight& light, const SpotProfile& spot, const PlaceBlock& p,
                       BlockIrradiance& r) {
    const glm::dvec3 l = light.position();
    const glm::dvec3 d = light.direction();
    const double radius_square = light.radius() * light.radius();
    const double half_pi_radius = 0.5 * pi * light.radius();
    const double cos_edge = spot.cos_edge();
    const double fade = spot.cos_fade_start() - cos_edge;
    const double per_fade = fade > 0.0 ? 1.0 / fade : 1e300;
    const double uneven_from = spot.with_cosine() ? 2.0 : spot.cos_fade_start();
    const double with_cosine = spot.with_cosine() ? 1.0 : 0.0;
    const std::size_t count = p.count;
    const double* p_x = p.x.data();
    const double* p_y = p.y.data();
    const double* p_z = p.z.data();
    double* value_out = r.value.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = p_x[i] - l.x;
        const double vy = p_y[i] - l.y;
        const double vz = p_z[i] - l.z;
        const double square = vx * vx + vy * vy + vz * vz;
        const double inverse = 1.0 / std::sqrt(square);
        const double cosine = (vx * d.x + vy * d.y + vz * d.z) * inverse;
        double t = (cosine - cos_edge) * per_fade;
        t = t > 0.0 ? t : 0.0;
        t = t < 1.0 ? t : 1.0;
        const double share = t * t * (3.0 - 2.0 * t) * (1.0 + with_cosine * (cosine - 1.0));
        // Within the lamp's angular radius (at most pi/2 times its sine, that at most r/d) the profile is not
        // even.
        const double margin = half_pi_radius * inverse;
        const bool uneven = margin > 2e-6 && cosine > cos_edge - margin && cosine < uneven_from + margin;
        const bool dark = cosine <= cos_edge - margin;
        special_out[i] = uneven ? 1.0
                         : dark ? (square < radius_square + min_square ? 1.0 : 0.0)
                                : special_out[i];
        value_out[i] *= share;
    }
}

void other_block(const PreparedLight& light, const PlaceBlock& p, BlockIrradiance& r) {
    for (std::size_t i = 0; i < p.count; ++i) {
        const glm::dvec3 towards = light.to_light({p.x[i], p.y[i], p.z[i]});
        r.cosine[i] = towards.x * p.nx[i] + towards.y * p.ny[i] + towards.z * p.nz[i];
        r.value[i] = 0.0;
        r.special[i] = 1.0;
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
std::int64_t normalise_block(PlaceBlock& p) {
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

void normalise(PlaceBlock& places) {
    if (normalise_block(places) == 0) return;
    for (std::size_t i = 0; i < places.count; ++i) {
        const glm::dvec3 given(places.nx[i], places.ny[i], places.nz[i]);
        const glm::dvec3 n = given == glm::dvec3(0.0) ? given : unit(given);
        places.nx[i] = n.x;
        places.ny[i] = n.y;
        places.nz[i] = n.z;
    }
}

bool any_special(const BlockIrradiance& one, std::size_t count) {
    return count_special(one, count) > 0;
}

void add_block(const BlockIrradiance& one, const glm::dvec3& strength, std::size_t count, BlockSum& sum) {
    add_strength(one, strength, count, sum);
}

void block_irradiance(const PreparedLight& light, const PlaceBlock& places, BlockIrradiance& result) {
    if (light.kind() == LightKind::sun) return sun_block(light, places, result);
    if (light.kind() == LightKind::area) {
        const AreaEmitter& area = *light.area();
        if (area.shape() != AreaShape::rectangle || area.spreads()) return other_block(light, places, result);
        return rectangle_block(light, area, places, result);
    }
    ball_block(light, places, result);
    if (light.kind() == LightKind::spot) spot_factor_block(light, *light.spot(), places, result);
}

}  // namespace skinglow
