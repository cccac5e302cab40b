#include <map>
#include <utility>

#include "geometry/vector.h"
#include "light/light_fields.h"
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

/// What is equal of lights that shine alike, but for their color and power. Vectors of a shape are directions,
/// whose length says nothing.
std::vector<double> geometry_of(const Light& light) {
    std::vector<double> key{static_cast<double>(light.kind())};
    const auto add = [&](const glm::dvec3& v) { key.insert(key.end(), {v.x, v.y, v.z}); };
    if (light.kind() != LightKind::sun) add(light.position());
    if (light.kind() != LightKind::point) add(unit(light.direction()));
    std::visit(
        [&](const auto& shape) {
            for_each_field_of(shape, [&](const auto& field, const auto& owner) {
                const auto& value = owner.*field.member;
                if constexpr (requires { add(value); }) {
                    add(unit(value));
                } else {
                    key.push_back(static_cast<double>(value));
                }
            });
        },
        light.shape());
    return key;
}

struct Stack {
    LightSettings first;
    CompensatedSumRgb positive, negative;
};

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

std::vector<Light> merge_identical(std::span<const Light> lights) {
    std::map<std::vector<double>, std::size_t> known;
    std::vector<Stack> stacks;
    for (const Light& light : lights) {
        if (!is_on(light)) continue;
        const auto [entry, is_new] = known.try_emplace(geometry_of(light), stacks.size());
        if (is_new) stacks.push_back({light.settings(), {}, {}});
        Stack& stack = stacks[entry->second];
        (light.power() > 0 ? stack.positive : stack.negative).add(light.color() * light.power());
    }
    std::vector<Light> merged;
    // A color is 0 or more in each channel: what subtracts light stays a light of its own.
    for (const Stack& stack : stacks) {
        for (const glm::dvec3& strength : {stack.positive.total(), stack.negative.total()}) {
            const double size = max_abs(strength);
            if (size == 0.0) continue;
            require_finite("sum of merged lights", size);
            LightSettings light = stack.first;
            light.power = strength.r + strength.g + strength.b < 0.0 ? -size : size;
            light.color = strength / light.power;
            merged.emplace_back(std::move(light));
        }
    }
    return merged;
}

}  // namespace skinglow
