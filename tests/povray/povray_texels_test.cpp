#include <gtest/gtest.h>
#include <skinglow/povray.h>

#include <limits>
#include <stdexcept>

using namespace skinglow;

namespace {

/// One triangle whose light is in an image.
PovrayScene triangle() {
    PovrayScene scene;
    scene.mesh.geometry = TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    scene.mesh.glow_uv = {{0.25, 0.5}, {0.75, 0.5}, {0.25, 0.5}};
    scene.lut.glow = PovrayGlow::texels;
    scene.lut.image = "tiles.exr";
    return scene;
}

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

TEST(PovrayTexels, ArePlacedByCorner) {
    const auto files = povray_files(triangle());
    EXPECT_TRUE(contains(files.at("mesh.inc"), "uv_vectors { 2,\n<0.25,0.5>, <0.75,0.5>\n"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "uv_indices { 1,\n<0,1,0>\n"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "Skinglow_Image_Pigment(\"tiles.exr\")"));
}

TEST(PovrayTexels, AreForTheGlowOfTwoParts) {
    PovrayScene scene = triangle();
    scene.mesh.surface_uv = {{0, 0}, {1, 0}, {0, 1}};
    scene.surface = PovraySurface{.image = "skin.png"};
    const std::string mesh = povray_files(scene).at("mesh.inc");
    EXPECT_TRUE(
        contains(mesh, "uv_indices { 1,\n<0,1,2>\n  }\n#else\n  uv_indices { 1,\n<0,1,0>\n  }\n#end\n"));
}

TEST(PovrayTexels, AreRefusedWhereTheyAreNotWhole) {
    PovrayScene scene = triangle();
    scene.mesh.glow_uv.pop_back();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.mesh.glow_uv[1].y = std::numeric_limits<double>::infinity();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.lut.image = "tiles.png";
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
}

}  // namespace
