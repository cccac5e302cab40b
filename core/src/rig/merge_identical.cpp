#include <map>

#include "geometry/vector.h"
#include "light/light_fields.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace {

/// What is equal of lights that shine alike, but for their color and power.
std::vector<double> geometry_of(const Light& light) {
    std::vector<double> key{static_cast<double>(light.kind())};
    const auto add = [&](const glm::dvec3& v) { key.insert(key.end(), {v.x, v.y, v.z}); };
    if (light.kind() != LightKind::sun) add(light.position());
    if (light.kind() != LightKind::point) add(light.direction());
    std::visit(
        [&](const auto& shape) {
            for_each_field_of(shape, [&](const auto& field, const auto& owner) {
                const auto& value = owner.*field.member;
                if constexpr (requires { add(value); }) {
                    add(value);
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

}  // namespace

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
