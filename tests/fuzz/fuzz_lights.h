#pragma once

#include <skinglow/light.h>

#include <numbers>
#include <vector>

#include "fuzz_input.h"
#include "require.h"

namespace skinglow::fuzz {

/// A light of any kind, most of them allowed; making a Light of it may refuse.
inline LightSettings light_from(FuzzInput& input) {
    LightSettings light;
    light.position = input.vector_in(-5.0, 5.0);
    light.direction = input.vector_in(-1.0, 1.0);
    light.color = input.vector_in(0.0, 1.0);
    light.power = input.near_range(-10.0, 1000.0);
    switch (input.below(4)) {
        case 0:
            light.shape = PointLight{input.near_range(0.0, 1.0), input.flag()};
            break;
        case 1:
            light.shape = SunLight{input.near_range(0.0, std::numbers::pi)};
            break;
        case 2:
            light.shape =
                SpotLight{input.near_range(0.0, 1.0), input.flag(), input.near_range(0.0, std::numbers::pi),
                          input.near_range(0.0, 1.0), input.flag()};
            break;
        default: {
            AreaLight area;
            area.area_shape = input.flag() ? AreaShape::ellipse : AreaShape::rectangle;
            area.size_x = input.near_range(0.0, 4.0);
            area.size_y = input.near_range(0.0, 4.0);
            area.tangent = input.vector_in(-1.0, 1.0);
            area.spread = input.flag() ? std::numbers::pi : input.near_range(0.0, std::numbers::pi);
            light.shape = area;
        }
    }
    return light;
}

/// Those that are allowed.
inline std::vector<Light> lights_from(FuzzInput& input, std::size_t most) {
    std::vector<Light> lights;
    for (std::size_t left = input.below(most + 1); left > 0; --left) {
        const LightSettings settings = light_from(input);
        runs([&] { lights.emplace_back(settings); });
    }
    return lights;
}

}  // namespace skinglow::fuzz
