#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "flat_light.h"

/// The paper's experiment (Table 1) and what Eq. 1-3 give for it with coefficients (1, 0, 1), worked out by
/// hand in exact fractions and rounded once, to double.
namespace table1 {

inline const std::array<double, 3> distance = {0.92357, 0.85231, 1.01292};
inline const std::array<double, 3> attenuation = {0.5396707823412062, 0.5792291878979711,
                                                  0.49358172816165746};
inline const std::array<glm::dvec3, 3> weight = {
    glm::dvec3(0.5396707823412062, 0.2370318730282945, 0.14602856463350286),
    glm::dvec3(0.034072305170468886, 0.14537516872733391, 0.5792291878979711),
    glm::dvec3(0.49358172816165746)};
inline const glm::dvec3 total = {1.0673248156733326, 0.8759887699172859, 1.2188394806931313};
/// B + L, and a gray entry of 0.25 recolored by it.
inline const glm::dvec3 blood_and_light = {2.8673248156733324, 1.375988769917286, 1.6188394806931314};
inline const glm::dvec3 quarter_gray = {0.7168312039183331, 0.3439971924793215, 0.40470987017328286};

/// The three lights, each at its distance from the origin in a direction of its own.
inline std::vector<skinglow::FlatLight> flat_lights() {
    const std::array<glm::dvec3, 3> bytes = {glm::dvec3(255, 112, 69), glm::dvec3(15, 64, 255),
                                             glm::dvec3(255, 255, 255)};
    const std::array<glm::dvec3, 3> away = {glm::dvec3(1, 0, 0), glm::dvec3(0, -0.6, 0.8),
                                            glm::dvec3(0, 0, -1)};
    std::vector<skinglow::FlatLight> lights(3);
    for (std::size_t k = 0; k < 3; ++k) {
        lights[k].color = bytes[k] / 255.0;
        lights[k].position = away[k] * distance[k];
        lights[k].name = "Light" + std::to_string(k + 1);
    }
    return lights;
}

inline std::vector<skinglow::Light> lights() {
    return skinglow::made(flat_lights());
}

}  // namespace table1
