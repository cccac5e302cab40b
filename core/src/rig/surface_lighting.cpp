#include <skinglow/surface_lighting.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "radiometry/area_angular_weight.h"
#include "radiometry/spherical_harmonics.h"
#include "rig/light_bounds.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

/// How an area light may be cut, coarsest first: tiles along its longer and its shorter side.
constexpr std::array<std::pair<int, int>, 5> tilings = {{{1, 1}, {2, 1}, {2, 2}, {4, 2}, {4, 4}}};

/// Where terms are measured: the box's corners, its center, and where it comes nearest to the light's axis,
/// where a spread peaks.
std::array<glm::dvec3, 10> test_points(const Box& box, const PreparedLight& light) {
    std::array<glm::dvec3, 10> points{};
    for (std::size_t i = 0; i < 8; ++i) {
        points[i] = {(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                     (i & 4U) != 0 ? box.max.z : box.min.z};
    }
    points[8] = box.center();
    const double along = glm::dot(box.center() - light.position(), light.direction());
    points[9] = glm::clamp(light.position() + along * light.direction(), box.min, box.max);
    return points;
}

/// A light of the rig and the terms it is cut into.
struct CutLight {
    const RigLight* source;
    double max;  ///< largest channel that it can give anywhere in the box
    std::size_t tiling = 0;
    double error = 0;  ///< of its terms, largest channel, W/m^2
    std::vector<SurfaceTerm> terms;

    const PreparedLight& light() const { return source->light; }
};

/// The lights that give the box anything, the brightest first.
std::vector<CutLight> lights_of_box(const PreparedRig& rig, const Box& box) {
    std::vector<CutLight> lights;
    for (const RigLight& one : rig.data().prepared) {
        if (!one.shines) continue;
        const double max = max_abs(one.scaled(irradiance_range(one.light, box).max));
        if (max > 0.0) lights.push_back({&one, max, 0, 0, {}});
    }
    std::stable_sort(lights.begin(), lights.end(),
                     [](const CutLight& a, const CutLight& b) { return a.max > b.max; });
    return lights;
}

/// Scales a light's terms so that they are exact where the box's center faces it: that removes most of the
/// error.
void calibrate(CutLight& cut, const glm::dvec3& center) {
    const glm::dvec3 facing = cut.light().to_light(center);
    double sum = 0;
    for (const SurfaceTerm& term : cut.terms) sum += max_abs(term.irradiance(center, facing, lambert_cubic));
    const double exact =
        max_abs(cut.source->scaled(cut.light().irradiance(center, facing, default_area_tolerance)));
    if (!(sum > 0.0) || !(exact > 0.0)) return;
    // A center on a spread's rim is no measure of the light.
    const double factor = exact / sum;
    if (factor < 0.5 || factor > 2.0) return;
    for (SurfaceTerm& term : cut.terms) term.strength *= factor;
}

/// The angles that terms are measured by: none, or the cubic as a weight, so that what the cubic itself is
/// off by does not ask for tiles.
struct Angles {
    AngularCubic cubic = lambert_cubic;
    std::optional<AngularWeight> weight;
};

Angles angles_of(const AngularWeight* angular_weight, std::span<const CutLight> lights) {
    if (angular_weight == nullptr) return {};
    Angles angles{angular_weight->cubic(), {}};
    // Other lights have but one angle at a point.
    const auto is_area = [](const CutLight& cut) { return cut.light().kind() == LightKind::area; };
    if (std::none_of(lights.begin(), lights.end(), is_area)) return angles;
    constexpr int steps = 32;
    std::vector<double> mu;
    std::vector<glm::dvec3> values;
    for (int i = 0; i <= steps; ++i) {
        mu.push_back(static_cast<double>(i) / steps);
        values.push_back(evaluate(angles.cubic, mu.back()));
    }
    angles.weight.emplace(mu, values);
    return angles;
}

/// Cuts a light and finds how far off its terms are.
void cut_into(CutLight& cut, std::size_t tiling, const Box& box, const Angles& angles) {
    const PreparedLight& light = cut.light();
    auto [columns, rows] = tilings[tiling];
    if (light.area() && light.area()->half_y() > light.area()->half_x()) std::swap(columns, rows);
    cut.tiling = tiling;
    cut.terms = surface_terms(light, cut.source->strength(), box.center(), columns, rows);
    cut.error = 0;
    if (light.kind() != LightKind::area) return;
    calibrate(cut, box.center());
    std::optional<AreaAngularWeight> by_angle;
    if (angles.weight) by_angle.emplace(light, *angles.weight);
    const auto measure = [&](const glm::dvec3& point, const glm::dvec3& normal) {
        glm::dvec3 sum = -cut.source->scaled(light.irradiance(point, normal, 1e-3));
        if (by_angle) sum *= by_angle->mean(point, normal);
        for (const SurfaceTerm& term : cut.terms) sum += term.irradiance(point, normal, angles.cubic);
        cut.error = std::max(cut.error, max_abs(sum));
    };
    for (const glm::dvec3& point : test_points(box, light)) measure(point, light.to_light(point));
    // Tilted by 60 and 90 degrees, where the horizon runs through a near light.
    const glm::dvec3 facing = light.to_light(box.center());
    for (const glm::dvec3& side :
         {light.frame()[0], -light.frame()[0], light.frame()[1], -light.frame()[1]}) {
        const glm::dvec3 across = side - glm::dot(side, facing) * facing;
        if (length(across) < 1e-3) continue;
        measure(box.center(), 0.5 * facing + std::sqrt(0.75) * unit(across));
        measure(box.center(), unit(across));
    }
}

std::size_t tilings_of(const PreparedLight& light) {
    if (!light.area()) return 1;
    return light.area()->shape() == AreaShape::ellipse ? 4 : tilings.size();
}

/// Cuts the light with the largest error further, as long as that matters and there is room.
void refine(std::span<CutLight> lights, const Box& box, const Angles& angles,
            const SurfaceLightingOptions& options) {
    std::size_t used = 0;
    double whole = 0;
    std::vector<CutLight*> open;
    for (CutLight& cut : lights) {
        used += cut.terms.size();
        whole += cut.max;
        open.push_back(&cut);
    }
    while (!open.empty()) {
        const auto worst =
            std::max_element(open.begin(), open.end(),
                             [](const CutLight* a, const CutLight* b) { return a->error < b->error; });
        CutLight& cut = **worst;
        if (cut.error <= options.tolerance * whole) return;
        const auto [columns, rows] =
            cut.tiling + 1 < tilings_of(cut.light()) ? tilings[cut.tiling + 1] : std::pair(0, 0);
        const auto wanted = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        if (wanted == 0 || used - cut.terms.size() + wanted > options.max_terms) {
            open.erase(worst);
            continue;
        }
        used += wanted - cut.terms.size();
        cut_into(cut, cut.tiling + 1, box, angles);
    }
}

}  // namespace

SurfaceLighting::SurfaceLighting(const PreparedRig& rig, const Box& box,
                                 const SurfaceLightingOptions& options) {
    validate(box);
    require_positive("tolerance", options.tolerance);
    std::vector<CutLight> lights = lights_of_box(rig, box);
    const std::span<CutLight> near(lights.data(), std::min(lights.size(), options.max_terms));
    const Angles angles = angles_of(options.angular_weight, near);
    angular_ = angles.cubic;
    for (CutLight& cut : near) cut_into(cut, 0, box, angles);
    refine(near, box, angles, options);

    for (const bool plain : {true, false}) {
        for (const CutLight& cut : near) {
            for (const SurfaceTerm& term : cut.terms) {
                if (term.is_plain() != plain) continue;
                require_finite("strength of light '" + rig.lights()[cut.source->index].name() + "'",
                               term.strength);
                terms_.push_back(term);
                lights_of_terms_.push_back(cut.source->index);
            }
        }
        if (plain) plain_terms_ = terms_.size();
    }

    std::array<glm::dvec3, 9> harmonics =
        options.environment != nullptr ? options.environment->coefficients() : std::array<glm::dvec3, 9>{};
    for (const CutLight& cut : std::span(lights).subspan(near.size())) {
        far_lights_.push_back(cut.source->index);
        const glm::dvec3 facing =
            cut.source->scaled(cut.light().facing_irradiance(box.center(), default_area_tolerance));
        const std::array<double, 9> basis = spherical_harmonics(cut.light().to_light(box.center()));
        for (std::size_t i = 0; i < 9; ++i) harmonics[i] += facing * basis[i];
    }
    std::sort(far_lights_.begin(), far_lights_.end());
    for (const glm::dvec3& each : harmonics) require_finite("sum of far lights", each);
    polynomial_ = irradiance_polynomial(harmonics, options.angular_weight);
}

glm::dvec3 SurfaceLighting::irradiance(const glm::dvec3& point, const glm::dvec3& normal) const {
    glm::dvec3 sum = polynomial_at(polynomial_, normal);
    for (const SurfaceTerm& term : terms_) sum += term.irradiance(point, normal, angular_);
    // The sum, not the polynomial: far lights of negative power take from the terms.
    return glm::max(sum, glm::dvec3(0.0));
}

}  // namespace skinglow
