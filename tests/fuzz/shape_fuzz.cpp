// Light through small shapes of any medium or tissue: finite, no light from nothing, no more out than in, linear.

#include <skinglow/box.h>
#include <skinglow/shape.h>

#include <algorithm>
#include <vector>

#include "fuzz_lights.h"
#include "fuzz_mesh.h"

namespace {

using namespace skinglow;

void check_light(const Shape& shape, fuzz::FuzzInput& input) {
    const std::vector<Light> lights = fuzz::lights_from(input, 3);
    ShapeLightOptions options;
    options.reentries = static_cast<int>(input.below(3));
    options.shadow_samples = 1;
    const LitShape lit = shape.light(lights, options);
    for (const glm::dvec3& e : lit.exitance()) fuzz::require(fuzz::is_finite(e), "exitance is finite");
    for (const glm::dvec3& e : lit.error())
        fuzz::require(fuzz::is_light(e), "an error is finite and not negative");
    bool adds = true;
    for (const Light& light : lights) adds = adds && light.power() >= 0;
    for (const glm::dvec3& e : lit.transmitted())
        fuzz::require(!adds || fuzz::is_light(e), "light is not negative");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    ShapeOptions options;
    options.cell_mm = input.near_range(0.8, 4.0);
    options.max_thickness_mm = input.near_decades(1.0, 100.0);
    options.unit_mm = input.flag() ? 1.0 : input.near_decades(0.1, 10.0);
    options.surface = input.flag() ? SurfaceFinish::smooth : SurfaceFinish::rough;
    options.threads = 1;
    ShapeMedium medium;
    medium.absorption = {input.near_decades(1e-6, 1e3), input.near_decades(1e-6, 1e3),
                         input.near_decades(1e-6, 1e3)};
    medium.reduced_scattering = {input.near_decades(1e-3, 1e3), input.near_decades(1e-3, 1e3),
                                 input.near_decades(1e-3, 1e3)};
    medium.refractive_index = input.flag() ? 1.0 : input.near_range(1.0, 3.0);
    const auto mesh = mesh_from(input);
    if (!mesh) return 0;
    runs([&] {
        // Many cells are slow, not wrong.
        const bool is_empty = mesh->vertices().empty();
        const double widest = is_empty ? 0.0 : 2 * box_of(mesh->vertices()).radius() * options.unit_mm;
        if (options.cell_mm > 0 && options.cell_mm < widest / 20)
            options.cell_mm = std::min(widest / 20, 1000.0);
        const Shape shape(*mesh, medium, options);
        const std::vector<glm::dvec3> dark(mesh->vertices().size(), glm::dvec3(0.0));
        for (const glm::dvec3& e : shape.exitance(dark))
            require(e == glm::dvec3(0.0), "no light without light");
        std::vector<glm::dvec3> lit = dark;
        for (glm::dvec3& e : lit) e = glm::dvec3(input.between(0.0, 2.0));
        for (const glm::dvec3& e : shape.exitance(lit))
            require(is_light(e), "exitance is finite and not negative");
        check_light(shape, input);
    });
    return 0;
}
