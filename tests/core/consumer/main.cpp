// Built by the test `installed_package` against the installed libraries and headers alone. A little of each part.
#include <skinglow/angular_weight.h>
#include <skinglow/box.h>
#include <skinglow/environment.h>
#include <skinglow/light.h>
#include <skinglow/light_weights.h>
#include <skinglow/lut.h>
#include <skinglow/mesh.h>
#include <skinglow/occlusion.h>
#include <skinglow/povray.h>
#include <skinglow/rig.h>
#include <skinglow/shape.h>
#include <skinglow/slab.h>
#include <skinglow/spectrum.h>
#include <skinglow/surface_lighting.h>
#include <skinglow/thickness.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

using namespace skinglow;

namespace {

int failures = 0;

void expect_near(const char* what, double value, double expected, double tolerance) {
    if (std::abs(value - expected) <= tolerance) return;
    std::printf("%s is %.17g, expected %.17g\n", what, value, expected);
    ++failures;
}

/// A box from `low` to `high`, its faces turned outwards.
TriangleMesh box(const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<glm::dvec3> vertices;
    for (int i = 0; i < 8; ++i) {
        vertices.push_back(
            {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
    }
    return {std::move(vertices),
            {{0, 2, 3},
             {0, 3, 1},
             {4, 5, 7},
             {4, 7, 6},
             {0, 1, 5},
             {0, 5, 4},
             {2, 6, 7},
             {2, 7, 3},
             {0, 4, 6},
             {0, 6, 2},
             {1, 3, 7},
             {1, 7, 5}}};
}

}  // namespace

int main() {
    const std::vector<Light> lights = {
        LightSettings{.shape = PointLight{}, .position = {0.0, 0.0, 2.0}, .power = 10.0}};
    expect_near("attenuation", light_weight(lights, {0.0, 0.0, 0.0}).x, 1.0 / 5.0, 1e-15);
    const double expected = 10.0 / (4.0 * std::numbers::pi * 4.0);
    expect_near("irradiance", object_irradiance(PreparedRig(lights), {0.0, 0.0, 0.0}).x, expected, 1e-12);

    const std::vector<Layer> glass = {{.refractive_index = 1.5, .thickness = 1.0}};
    const SlabResult through = slab(glass, Incidence::normal());
    expect_near("R + T of clear glass", through.reflectance + through.transmittance, 1.0, 1e-12);

    const BaseLut base = base_lut(tissue_preset("light").tissue, 16);
    const std::vector<glm::dvec3> shown = recolor(base, {1.0, 1.0, 1.0});
    expect_near("entries", static_cast<double>(shown.size()), 16.0, 0.0);
    if (!(shown[2].x > shown[2].z && shown[2].z > 0.0)) {
        std::printf("thin skin does not let red through best\n");
        ++failures;
    }

    const TriangleMesh skin = box({-1.0, -1.0, -0.1}, {1.0, 1.0, 0.1});
    expect_near("thickness", thickness(skin, {.unit_mm = 10.0}).front(), 2.0, 1.0);
    const TriangleMesh wall = box({-1.0, -1.0, 1.0}, {1.0, 1.0, 1.1});
    const std::vector<MeshView> meshes = {skin, wall};
    const Occluders occluders(meshes);
    const std::vector<glm::dvec3> points = {{0.0, 0.0, 0.1}};
    const std::vector<glm::dvec3> normals = {{0.0, 0.0, 1.0}};
    const auto seen = [&](std::vector<std::size_t> excluded) {
        return visible_fraction(occluders, lights, points, normals, {.excluded = std::move(excluded)})
            .mean[0];
    };
    expect_near("light behind a wall", seen({0}), 0.0, 0.0);
    expect_near("light without the wall", seen({0, 1}), 1.0, 0.0);

    const Shape plate(skin, ShapeMedium{glm::dvec3(0.1), glm::dvec3(1.0)});
    expect_near("parts of a plate", static_cast<double>(plate.parts().size()), 1.0, 0.0);

    PovrayScene scene;
    scene.mesh.geometry = skin;
    scene.mesh.lut_u.assign(skin.vertices().size(), 0.5);
    scene.lut.base = gray_entries(six_gaussian_base(scene.lut.axis));
    scene.lights = lights;
    expect_near("POV-Ray's scene", static_cast<double>(povray_files(scene).count("scene.pov")), 1.0, 0.0);
    return failures;
}
