#include "radiometry/irradiance_sum.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"

namespace skinglow::detail {
namespace {

using Kernel = KernelLight::Kernel;

/// Beyond this, squares of squares overflow: such lights are asked one by one.
constexpr double max_vectorized = 1e70;

Kernel kernel_of(const PreparedLight& light) {
    if (!(std::max(max_abs(light.position()), light.radius()) < max_vectorized)) return Kernel::none;
    if (light.kind() == LightKind::sun) return Kernel::sun;
    if (light.kind() == LightKind::point) return Kernel::point;
    if (light.kind() == LightKind::spot) return Kernel::spot;
    const bool has_kernel = light.area()->shape() == AreaShape::rectangle && !light.area()->spreads() &&
                            !light.area()->is_thin() && light.area_scale() >= 0.5e-9;
    return has_kernel ? Kernel::rectangle : Kernel::none;
}

KernelLight kernel_light(const RigLight& one) {
    constexpr double min_sq = min_light_distance * min_light_distance;
    const PreparedLight& light = one.light;
    KernelLight k{.kernel = kernel_of(light),
                  .light = &light,
                  .strength = one.strength(),
                  .position = light.position(),
                  .reverse_axis = -light.direction(),
                  .sin_sun_radius = light.sin_sun_radius(),
                  .radius_sq = light.radius() * light.radius(),
                  .half_pi_radius = 0.5 * std::numbers::pi * light.radius(),
                  .x_axis = light.frame()[0],
                  .y_axis = light.frame()[1]};
    k.softening_sq = light.soft_falloff() ? k.radius_sq : 0.0;
    k.min_distance_sq = light.soft_falloff() ? min_sq : std::max(k.radius_sq, min_sq);
    if (light.spot()) {
        const SpotProfile& spot = *light.spot();
        const double fade = spot.cos_fade_start() - spot.cos_edge();
        k.cos_edge = spot.cos_edge();
        k.fade_scale = fade > 0.0 ? 1.0 / fade : 1e300;
        k.cos_uneven = spot.with_cosine() ? 2.0 : spot.cos_fade_start();
        k.cosine_falloff = spot.with_cosine() ? 1.0 : 0.0;
    }
    if (light.area()) {
        k.half_x = light.area()->half_x() * light.area_scale();
        k.half_y = light.area()->half_y() * light.area_scale();
    }
    return k;
}

}  // namespace

IrradianceSum::IrradianceSum(std::span<const RigLight> lights, const AngularWeight* angular_weight,
                             double tolerance)
    : angular_weight_(angular_weight), tolerance_(tolerance) {
    for (const RigLight& one : lights) {
        if (one.shines) lights_.push_back(kernel_light(one));
    }
    std::ranges::stable_sort(lights_, {}, &KernelLight::kernel);
    if (angular_weight == nullptr) return;
    for (const KernelLight& k : lights_) {
        area_weights_.emplace_back();
        if (k.light->area()) area_weights_.back().emplace(*k.light, *angular_weight);
    }
}

void IrradianceSum::add_one(const KernelLight& light, const glm::dvec3& point, const glm::dvec3& unit_normal,
                            double value, double cosine, glm::dvec3& sum) const {
    if (unit_normal == glm::dvec3(0.0)) return;
    if (std::isnan(value)) value = light.light->irradiance(point, unit_normal, tolerance_);
    if (value == 0.0) return;
    glm::dvec3 weighted = light.strength * value;
    if (has_angular_weight()) {
        const auto& area_weight = area_weights_[static_cast<std::size_t>(&light - lights_.data())];
        if (!area_weight && std::isnan(cosine)) cosine = glm::dot(light.light->to_light(point), unit_normal);
        weighted *= area_weight ? area_weight->mean(point, unit_normal) : angular_weight_->at(cosine);
    }
    sum += weighted;
}

void IrradianceSum::add_one_by_one(std::span<const KernelLight> lights, const glm::dvec3& point,
                                   const glm::dvec3& normal, glm::dvec3& sum) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!is_finite(point) || !is_finite(normal)) sum = glm::dvec3(nan);
    if (normal == glm::dvec3(0.0) || !is_finite(sum)) return;
    const glm::dvec3 unit_normal = unit(normal);
    for (const KernelLight& light : lights) add_one(light, point, unit_normal, nan, nan, sum);
}

}  // namespace skinglow::detail
