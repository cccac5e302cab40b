#include <utility>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace detail {

RigData::RigData(std::vector<Light> given) : lights(std::move(given)) {
    prepared.reserve(lights.size());
    for (const Light& light : lights) {
        const PreparedLight ready(light);
        prepared.push_back(
            {prepared.size(), ready, light.color(), light.power(), is_on(light) && !ready.dark()});
    }
}

glm::dvec3 unit_normal(const glm::dvec3& normal) {
    require_finite("normal", normal);
    if (normal == glm::dvec3(0.0)) refuse_argument("normal", to_text(normal), "a vector of length above 0");
    return unit(normal);
}

}  // namespace detail

PreparedRig::PreparedRig(std::vector<Light> lights) : data_(std::make_shared<RigData>(std::move(lights))) {}

const std::vector<Light>& PreparedRig::lights() const {
    return data_->lights;
}

namespace {

/// What a light gives, finite or refused by its name.
glm::dvec3 checked(const PreparedRig& rig, const RigLight& one, double per_power) {
    const auto name = [&] { return "irradiance of light \"" + rig.lights()[one.index].name() + "\""; };
    return require_finite(name, one.scaled(per_power));
}

}  // namespace

glm::dvec3 irradiance_at(const PreparedRig& rig, const glm::dvec3& point, const glm::dvec3& normal,
                         double tolerance) {
    require_finite("point", point);
    require_positive("tolerance", tolerance);
    const glm::dvec3 facing = unit_normal(normal);
    CompensatedSumRgb sum;
    for (const RigLight& one : rig.data().prepared) {
        if (one.shines) sum.add(checked(rig, one, one.light.irradiance(point, facing, tolerance)));
    }
    return require_finite("sum of irradiance", sum.total());
}

std::vector<glm::dvec3> object_irradiance_by_light(const PreparedRig& rig, const glm::dvec3& point,
                                                   double tolerance) {
    require_finite("point", point);
    require_positive("tolerance", tolerance);
    std::vector<glm::dvec3> parts(rig.size(), glm::dvec3(0.0));
    for (const RigLight& one : rig.data().prepared) {
        if (one.shines) parts[one.index] = checked(rig, one, one.light.facing_irradiance(point, tolerance));
    }
    return parts;
}

glm::dvec3 object_irradiance(const PreparedRig& rig, const glm::dvec3& point, double tolerance) {
    CompensatedSumRgb sum;
    for (const glm::dvec3& part : object_irradiance_by_light(rig, point, tolerance)) sum.add(part);
    return require_finite("sum of irradiance", sum.total());
}

}  // namespace skinglow
