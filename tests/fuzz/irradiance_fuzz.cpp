// Irradiance of lights of every kind: finite; one point as many; culling keeps its bound; one weight for a box is off by no
// more than it says.

#include <skinglow/rig.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <variant>
#include <vector>

#include "fuzz_lights.h"
#include "require.h"

namespace {

using namespace skinglow;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Brightest that an area light with a spread can be at this distance, W/m^2: what its integrals' tolerance is relative to. Outside
/// of its beam they leave the rounding of parts that cancel, not 0.
double beam_irradiance(const Light& light, const glm::dvec3& point) {
    const AreaLight* area = std::get_if<AreaLight>(&light.settings().shape);
    if (area == nullptr || area->spread >= std::numbers::pi) return 0;
    const double lit = area->size_x * area->size_y;
    const double tangent = std::tan(0.5 * area->spread);
    const double gain = tangent < 0.01 ? 3 / (tangent * tangent) : tangent / (tangent - std::atan(tangent));
    const glm::dvec3 away = point - light.position();
    const double at_light = std::abs(light.power()) * largest(light.color()) / lit;
    const double here = at_light * std::min(1.0, lit * gain / glm::dot(away, away));
    return std::isfinite(here) ? here : 0;
}

/// Rounding of a sum over these lights at this point, W/m^2.
double rounding(const std::vector<Light>& lights, const glm::dvec3& point) {
    double sum = 0;
    for (const glm::dvec3& e : object_irradiance_by_light(lights, point)) sum += largest(e);
    double beams = 0;
    for (const Light& light : lights) beams += beam_irradiance(light, point);
    constexpr double denormal = 1e-250;  // products of numbers that have lost their digits
    return 1e-6 * sum + 1e-13 * beams + denormal;
}

void check_culling(const std::vector<Light>& lights, const Box& box, double tolerance,
                   const glm::dvec3& point, const glm::dvec3& normal) {
    const PreparedRig rig(lights);
    const CullingResult culled = rig.cull(box, tolerance);
    fuzz::require(largest(culled.bound) <= tolerance * (1 + 1e-9), "culling stays within its tolerance");
    std::vector<Light> kept;
    for (const std::size_t i : culled.kept) kept.push_back(lights[i]);
    const glm::dvec3 missing = irradiance_at(rig, point, normal) - irradiance_at(kept, point, normal);
    fuzz::require(largest(missing) <= largest(culled.bound) * (1 + 1e-6) + rounding(lights, point),
                  "lights that are culled give no more than their bound");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    const glm::dvec3 corner = input.vector_in(-1.0, 1.0);
    const glm::dvec3 extent = input.vector_in(0.0, 1.0);
    const double tolerance = input.near_decades(1e-9, 10.0);
    const glm::dvec3 normal = input.vector_in(-1.0, 1.0);
    const glm::dvec3 part{input.between(0.0, 1.0), input.between(0.0, 1.0), input.between(0.0, 1.0)};
    const std::vector<Light> lights = lights_from(input, 4);
    const Box box{corner, corner + extent};
    const glm::dvec3 point = glm::clamp(corner + part * extent, box.min, box.max);
    runs([&] {
        const glm::dvec3 one = irradiance_at(lights, point, normal);
        require(is_finite(one), "irradiance is finite");
        const bool adds =
            std::all_of(lights.begin(), lights.end(), [](const Light& l) { return l.power() >= 0; });
        require(!adds || is_light(one), "lights of positive power give no negative light");
        const std::vector<glm::dvec3> points{point}, normals{normal};
        const glm::dvec3 many = surface_irradiance(lights, points, normals, {.threads = 1})[0];
        require(largest(many - one) <= rounding(lights, point), "many points have what single ones have");
    });
    runs([&] { check_culling(lights, box, tolerance, point, normal); });
    runs([&] {
        const glm::dvec3 center = box.center();
        const glm::dvec3 bound = object_irradiance_error(lights, center, box);
        const glm::dvec3 off = object_irradiance(lights, point) - object_irradiance(lights, center);
        const double round = rounding(lights, point) + rounding(lights, center);
        require(largest(off) <= largest(bound) * (1 + 1e-6) + round,
                "one weight is off by no more than its bound");
    });
    return 0;
}
