#include "shape/thick_skin.h"

#include <gtest/gtest.h>
#include <skinglow/shape.h>
#include <skinglow/slab.h>
#include <skinglow/spectrum.h>
#include <skinglow/tissue.h>

#include <array>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "shape/spectral_nodes.h"

namespace skinglow {
namespace {

TEST(ThickSkin, IsWhatLayersSendBackWithoutTheSurface) {
    const Tissue tissue = tissue_preset("medium").tissue;
    const Spectrum found = thick_skin(tissue);
    for (const std::size_t k : {4U, 30U, 50U, 80U}) {
        const SkinMedia media = skin_media(tissue, sample_wavelength_nm(k));
        std::array layers{media.epidermis, media.inner};
        layers[1].thickness = std::numeric_limits<double>::infinity();
        const double all = slab(layers, Incidence::diffuse(), 1, 1, 32).reflectance;
        // Of diffuse light, a surface of index 1.4 throws back 7.7 %.
        EXPECT_NEAR(found[k], all - 0.0768, 0.002 + 0.01 * all);
    }
}

TEST(ThickSkin, IsDividedAmongTheNodes) {
    const Tissue tissue;
    glm::dmat3 sum(0.0);
    for (const glm::dmat3& part : spectral_nodes(tissue).thick) sum += part;
    const glm::dmat3 all = transmission_matrix(thick_skin(tissue));
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(sum[c][r], all[c][r], 1e-9);
    }
}

TEST(ThickSkin, IsWhatAHalfSpaceOfASmoothSurfaceSendsBack) {
    const std::vector<glm::dvec3> vertices{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}};
    const std::vector<glm::dvec3> light(3, {1.0, 0.5, 0.2});
    for (const char* const name : {"very_light", "medium", "very_dark"}) {
        const Tissue tissue = tissue_preset(name).tissue;
        const Shape shape({vertices, triangles}, tissue, {.surface = SurfaceFinish::smooth});
        const glm::dvec3 expected = transmission_matrix(thick_skin(tissue)) * light[0];
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(shape.exitance(light)[0][c], expected[c], 1e-6) << name;
    }
}

}  // namespace
}  // namespace skinglow
