#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "geometry/vector.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

using std::numbers::pi;
/// A spot without blend has a rim all the same, so narrow that single precision just resolves it.
constexpr double narrowest_rim = 1e-6;
/// Avoids 0 / 0 for lights without a size.
constexpr double tiny = 1e-300;

/// The cosine to a light with an angular radius of that sine, of which the horizon hides a part: between
/// -sine and sine a parabola, whose ends fit the straight parts in value and slope.
double received_fraction(double cosine, double sine) {
    const double above = std::clamp(cosine + sine, 0.0, 2.0 * sine);
    return above * above / (4.0 * sine + tiny) + std::max(cosine - sine, 0.0);
}

SurfaceTerm sun_term(const PreparedLight& light, const glm::dvec3& strength) {
    SurfaceTerm term;
    term.position = term.reverse_axis = -light.direction();
    term.is_positional = 0.0;
    const double sine = std::min(light.sin_sun_radius(), 1.0 - 1e-9);
    term.radius_sq = sine * sine / (1.0 - sine * sine);  // seen from a distance of 1
    term.strength = strength * (1.0 + term.radius_sq);
    return term;
}

SurfaceTerm ball_term(const PreparedLight& light, const glm::dvec3& strength, const glm::dvec3& center) {
    SurfaceTerm term;
    term.position = light.position();
    term.radius_sq = std::max(light.radius() * light.radius(), min_light_distance * min_light_distance);
    term.strength = strength / (4.0 * pi);
    if (!light.soft_falloff()) {
        const double distance = std::max(light.distance(center), light.radius());
        if (distance > 0.0) term.strength *= 1.0 + term.radius_sq / distance / distance;
    }
    if (light.kind() != LightKind::spot) return term;
    const SpotProfile& spot = *light.spot();
    const double rim = std::max(spot.cos_fade_start() - spot.cos_edge(), narrowest_rim);
    term.reverse_axis = -light.direction();
    term.cos_scale = 1.0 / rim;
    term.bias = -spot.cos_edge() / rim;
    term.smoothstep = 1.0;
    term.cosine_falloff = spot.with_cosine() ? 1.0 : 0.0;
    return term;
}

using Tiles = std::vector<glm::dvec2>;

/// Centers of equal tiles of a rectangle, in units of its half axes.
Tiles rectangle_tiles(int columns, int rows) {
    Tiles tiles;
    tiles.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j)
            tiles.emplace_back((2.0 * i + 1.0) / columns - 1.0, (2.0 * j + 1.0) / rows - 1.0);
    }
    return tiles;
}

/// Adds the centers of mass of equal sectors of a ring between radii p and r: of half angle a, at
/// 2 sin(a) / (3 a) (r^3 - p^3) / (r^2 - p^2) from the center.
void add_ring(Tiles& tiles, int sectors, double p, double r, double first_angle) {
    const double a = pi / sectors;
    const double radius = 2.0 * std::sin(a) / (3.0 * a) * (r * r * r - p * p * p) / (r * r - p * p);
    for (int i = 0; i < sectors; ++i) {
        const double angle = first_angle + 2.0 * a * i;
        tiles.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
}

/// Equal pieces of a unit disk: the whole, halves, quarters, or an inner and an outer ring of quarters each.
Tiles disk_tiles(int columns, int rows) {
    const int count = columns * rows;
    if (count == 1) return {{0.0, 0.0}};
    Tiles tiles;
    const double inner_radius = count == 8 ? std::sqrt(0.5) : 1.0;
    add_ring(tiles, std::min(count, 4), 0.0, inner_radius, count > 2 ? pi / 4 : columns == 2 ? 0.0 : pi / 2);
    // The outer quarters stand between the inner ones, on the axes.
    if (count == 8) add_ring(tiles, 4, inner_radius, 1.0, 0.0);
    return tiles;
}

std::vector<SurfaceTerm> area_terms(const PreparedLight& light, const glm::dvec3& strength, int columns,
                                    int rows) {
    const AreaEmitter& area = *light.area();
    const double scale = light.area_scale();
    const Tiles tiles =
        area.shape() == AreaShape::ellipse ? disk_tiles(columns, rows) : rectangle_tiles(columns, rows);
    const auto count = static_cast<double>(tiles.size());
    SurfaceTerm term;
    term.reverse_axis = -light.direction();
    // On its axis a disk of this radius gives P / (pi (d^2 + r^2)).
    term.radius_sq =
        std::max(area.area() * scale * scale / pi / count, min_light_distance * min_light_distance);
    term.strength = strength * (area.axis_gain() / pi / count);
    term.cos_scale = 1.0;
    term.bias = 0.0;
    term.sin_scale = area.spreads() ? -1.0 / std::tan(area.half_spread()) : 0.0;
    std::vector<SurfaceTerm> terms;
    terms.reserve(tiles.size());
    for (const glm::dvec2& tile : tiles) {
        term.position = light.point_on_area(tile.x, tile.y);
        terms.push_back(term);
    }
    return terms;
}

}  // namespace

glm::dvec3 SurfaceTerm::irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                   const AngularCubic& angular) const {
    const glm::dvec3 offset = position - is_positional * point;
    const double distance = length(offset);
    const double sphere_distance = std::hypot(distance, std::sqrt(radius_sq));
    const glm::dvec3 to_light = distance > 0.0 ? offset / distance : normal;
    const double mu = glm::dot(normal, to_light);
    const double received = received_fraction(mu, std::sqrt(radius_sq) / sphere_distance);
    const double c = glm::dot(reverse_axis, to_light);
    const double t =
        std::clamp(cos_scale * c + bias + sin_scale * std::sqrt(std::max(0.0, 1.0 - c * c)), 0.0, 1.0);
    const double profile =
        t * (1.0 + smoothstep * (t * (3.0 - 2.0 * t) - 1.0)) * (1.0 + cosine_falloff * (c - 1.0));
    return strength * evaluate(angular, mu) * (received * profile / sphere_distance / sphere_distance);
}

std::vector<SurfaceTerm> detail::surface_terms(const PreparedLight& light, const glm::dvec3& strength,
                                               const glm::dvec3& center, int columns, int rows) {
    if (light.dark()) return {};
    if (light.kind() == LightKind::sun) return {sun_term(light, strength)};
    if (light.kind() == LightKind::area) return area_terms(light, strength, columns, rows);
    return {ball_term(light, strength, center)};
}

}  // namespace skinglow
