#pragma once

#include <skinglow/rig.h>

/// Lights whose fields tests change one by one, the kind among them.
namespace skinglow {

struct FlatLight {
    LightKind kind = LightKind::point;
    glm::dvec3 color{1.0};
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};
    double power = 1.0;
    std::string name;
    bool visible = true;
    double radius = 0.0;
    bool soft_falloff = true;
    double sun_angle = 0.0;
    double spot_angle = SpotLight{}.spot_angle;
    double spot_blend = SpotLight{}.spot_blend;
    bool spot_cosine = false;
    AreaShape area_shape = AreaShape::rectangle;
    double size_x = AreaLight{}.size_x;
    double size_y = AreaLight{}.size_y;
    glm::dvec3 tangent{1.0, 0.0, 0.0};
    double spread = AreaLight{}.spread;

    LightShape shape() const {
        switch (kind) {
            case LightKind::point:
                return PointLight{radius, soft_falloff};
            case LightKind::sun:
                return SunLight{sun_angle};
            case LightKind::spot:
                return SpotLight{radius, soft_falloff, spot_angle, spot_blend, spot_cosine};
            case LightKind::area:
                break;
        }
        return AreaLight{area_shape, size_x, size_y, tangent, spread};
    }

    operator Light() const {  // NOLINT(google-explicit-constructor)
        return LightSettings{shape(), color, position, direction, power, name, visible};
    }
};

inline std::vector<Light> made(const std::vector<FlatLight>& lights) {
    return {lights.begin(), lights.end()};
}

}  // namespace skinglow
