// Built by the test `installed_package` against the installed skinglow::core alone.
#include <skinglow/light/light_weights.h>
#include <skinglow/skin/fixed_lookup.h>
#include <skinglow/skin/recolour.h>

#include <cstdio>

int main() {
    skinglow::Light lamp;
    lamp.color = {0.0, 0.0, 1.0};
    const skinglow::BaseLut base = skinglow::six_gaussian_base({16, 12.0});
    const glm::dvec3 weight = skinglow::light_weight({&lamp, 1}, glm::dvec3(1.0, 0.0, 0.0));
    const auto lut = skinglow::recolour(base, skinglow::paper_blood_weight + weight);
    std::printf("blue at no thickness: %.3f\n", lut.front().z);
    return lut.front().z > 0.89 && lut.front().z < 0.91 ? 0 : 1;  // 0.4 of blood + 1 / (1 + 1^2) of the lamp
}
