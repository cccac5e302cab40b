#include "rig/surface_lighting.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "numerics/argument_check.h"
#include "radiometry/area_angular_weight.h"
#include "radiometry/spherical_harmonics.h"

namespace skinglow {
namespace {

/// How an area lamp may be cut, coarsest first: tiles along its longer and its shorter side.
constexpr std::array<std::pair<int, int>, 5> tilings = {{{1, 1}, {2, 1}, {2, 2}, {4, 2}, {4, 4}}};

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The box's corners, its middle, and where it comes nearest to the lamp's axis: there a spread peaks.
std::array<glm::dvec3, 10> telling_places(const Box& box, const PreparedLight& light) {
    std::array<glm::dvec3, 10> places{};
    for (std::size_t i = 0; i < 8; ++i) {
        places[i] = {(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                     (i & 4U) != 0 ? box.max.z : box.min.z};
    }
    places[8] = box.center();
    const double along = glm::dot(box.center() - light.position(), light.direction());
    places[9] = glm::clamp(light.position() + along * light.direction(), box.min, box.max);
    return places;
}

struct Lamp {
    std::size_t index;
    PreparedLight light;
    glm::dvec3 strength;  ///< power * color
    double most;          ///< largest channel that it can give anywhere in the box
    std::size_t tiling = 0;
    double error = 0;  ///< of its terms, largest channel, W/m^2
    std::vector<SurfaceTerm> terms;
};

std::vector<Lamp> lamps_that_shine(std::span<const Light> lights, const Box& box) {
    std::vector<Lamp> lamps;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        validate(lights[i]);
        if (!is_on(lights[i])) continue;
        const PreparedLight prepared(lights[i]);
        const glm::dvec3 strength = lights[i].color * lights[i].power;
        const double most = irradiance_range(prepared, box).max * largest(strength);
        if (most > 0.0) lamps.push_back({i, prepared, strength, most, 0, 0, {}});
    }
    std::stable_sort(lamps.begin(), lamps.end(),
                     [](const Lamp& a, const Lamp& b) { return a.most > b.most; });
    return lamps;
}

/// Scales a lamp's terms so that they are exact where the box's middle faces it: that takes most of the error
/// away.
void calibrate(Lamp& lamp, const glm::dvec3& middle) {
    const glm::dvec3 facing = lamp.light.to_light(middle);
    double sum = 0;
    for (const SurfaceTerm& term : lamp.terms) sum += largest(term.irradiance(middle, facing, lambert_cubic));
    const double exact =
        lamp.light.irradiance(middle, facing, default_area_tolerance) * largest(lamp.strength);
    if (!(sum > 0.0) || !(exact > 0.0)) return;
    // A middle on a spread's rim is no measure of the lamp.
    const double factor = exact / sum;
    if (factor < 0.5 || factor > 2.0) return;
    for (SurfaceTerm& term : lamp.terms) term.strength *= factor;
}

/// The angles that terms are measured by: none, or the cubic as a weight, so that what the cubic itself is
/// off by does not ask for tiles.
struct Angles {
    AngularCubic cubic = lambert_cubic;
    std::optional<AngularWeight> weight;
};

Angles angles_of(const AngularWeight* angular_weight, std::span<const Lamp> lamps) {
    if (angular_weight == nullptr) return {};
    Angles angles{angular_weight->cubic(), {}};
    // Other lamps have but one angle at a place.
    const auto is_area = [](const Lamp& lamp) { return lamp.light.kind() == LightKind::area; };
    if (std::none_of(lamps.begin(), lamps.end(), is_area)) return angles;
    constexpr int steps = 32;
    std::vector<double> mu;
    std::vector<glm::dvec3> values;
    for (int i = 0; i <= steps; ++i) {
        mu.push_back(static_cast<double>(i) / steps);
        values.push_back(glm::max(evaluate(angles.cubic, mu.back()), glm::dvec3(0.0)));
    }
    angles.weight.emplace(mu, values);
    return angles;
}

/// Cuts a lamp and finds how far off its terms are.
void cut(Lamp& lamp, std::size_t tiling, const Box& box, const Angles& angles) {
    auto [columns, rows] = tilings[tiling];
    if (lamp.light.area() && lamp.light.area()->half_y() > lamp.light.area()->half_x())
        std::swap(columns, rows);
    lamp.tiling = tiling;
    lamp.terms = surface_terms(lamp.light, lamp.strength, box.center(), columns, rows);
    lamp.error = 0;
    if (lamp.light.kind() != LightKind::area) return;
    calibrate(lamp, box.center());
    std::optional<AreaAngularWeight> by_angle;
    if (angles.weight) by_angle.emplace(lamp.light, *angles.weight);
    const auto measure = [&](const glm::dvec3& place, const glm::dvec3& normal) {
        glm::dvec3 sum = -lamp.light.irradiance(place, normal, 1e-3) * lamp.strength;
        if (by_angle) sum *= by_angle->mean(place, normal);
        for (const SurfaceTerm& term : lamp.terms) sum += term.irradiance(place, normal, angles.cubic);
        lamp.error = std::max(lamp.error, largest(sum));
    };
    for (const glm::dvec3& place : telling_places(box, lamp.light))
        measure(place, lamp.light.to_light(place));
    // Tilted by 60 and 90 degrees, where the horizon runs through a near lamp.
    const glm::dvec3 facing = lamp.light.to_light(box.center());
    const glm::dmat3& frame = lamp.light.frame();
    for (const glm::dvec3& side : {frame[0], -frame[0], frame[1], -frame[1]}) {
        const glm::dvec3 across = side - glm::dot(side, facing) * facing;
        if (glm::length(across) < 1e-3) continue;
        measure(box.center(), 0.5 * facing + std::sqrt(0.75) * glm::normalize(across));
        measure(box.center(), glm::normalize(across));
    }
}

std::size_t most_tilings(const Lamp& lamp) {
    if (!lamp.light.area()) return 1;
    return lamp.light.area()->shape() == AreaShape::ellipse ? 4 : tilings.size();
}

/// Cuts the lamp with the largest error further, as long as that matters and there is room.
void refine(std::span<Lamp> lamps, const Box& box, const Angles& angles,
            const SurfaceLightingOptions& options) {
    std::size_t used = 0;
    double whole = 0;
    for (const Lamp& lamp : lamps) {
        used += lamp.terms.size();
        whole += lamp.most;
    }
    std::vector<Lamp*> open;
    for (Lamp& lamp : lamps) open.push_back(&lamp);
    while (!open.empty()) {
        const auto worst = std::max_element(open.begin(), open.end(),
                                            [](const Lamp* a, const Lamp* b) { return a->error < b->error; });
        Lamp& lamp = **worst;
        if (lamp.error <= options.tolerance * whole) return;
        const auto [columns, rows] =
            lamp.tiling + 1 < most_tilings(lamp) ? tilings[lamp.tiling + 1] : std::pair(0, 0);
        const auto wanted = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        if (wanted == 0 || used - lamp.terms.size() + wanted > options.max_terms) {
            open.erase(worst);
            continue;
        }
        used += wanted - lamp.terms.size();
        cut(lamp, lamp.tiling + 1, box, angles);
    }
}

}  // namespace

SurfaceLighting::SurfaceLighting(std::span<const Light> lights, const Box& box,
                                 const Environment* environment, const AngularWeight* angular_weight,
                                 const SurfaceLightingOptions& options) {
    validate(box);
    require_positive("tolerance", options.tolerance);
    std::vector<Lamp> lamps = lamps_that_shine(lights, box);
    const std::span<Lamp> near(lamps.data(), std::min(lamps.size(), options.max_terms));
    const Angles angles = angles_of(angular_weight, near);
    angular_ = angles.cubic;
    for (Lamp& lamp : near) cut(lamp, 0, box, angles);
    refine(near, box, angles, options);

    const auto take = [&](bool plain) {
        for (const Lamp& lamp : near) {
            for (const SurfaceTerm& term : lamp.terms) {
                if (term.is_plain() != plain) continue;
                require_finite("strength of light '" + lights[lamp.index].name + "'", term.strength);
                terms_.push_back(term);
                lights_of_terms_.push_back(lamp.index);
            }
        }
    };
    take(true);
    plain_terms_ = terms_.size();
    take(false);

    std::array<glm::dvec3, 9> harmonics =
        environment != nullptr ? environment->coefficients() : std::array<glm::dvec3, 9>{};
    for (const Lamp& lamp : std::span(lamps).subspan(near.size())) {
        far_lights_.push_back(lamp.index);
        const glm::dvec3 facing =
            lamp.light.facing_irradiance(box.center(), default_area_tolerance) * lamp.strength;
        const std::array<double, 9> basis = spherical_harmonics(lamp.light.to_light(box.center()));
        for (std::size_t i = 0; i < 9; ++i) harmonics[i] += facing * basis[i];
    }
    std::sort(far_lights_.begin(), far_lights_.end());
    polynomial_ = Environment(harmonics).irradiance_polynomial(angular_weight);
}

glm::dvec3 SurfaceLighting::irradiance(const glm::dvec3& point, const glm::dvec3& normal) const {
    const std::array<double, 9> at = harmonic_monomials(normal);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < 9; ++i) sum += polynomial_[i] * at[i];
    sum = glm::max(sum, glm::dvec3(0.0));
    for (const SurfaceTerm& term : terms_) sum += term.irradiance(point, normal, angular_);
    return sum;
}

}  // namespace skinglow
