#include <skinglow/povray.h>

#include <gtest/gtest.h>
#include <skinglow/lut.h>

#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>

#include "povray/sdl_text.h"
#include "table1.h"

using namespace skinglow;

namespace {

/// One triangle before the paper's three lamps.
PovrayScene triangle() {
    PovrayScene scene;
    scene.mesh.geometry = TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    scene.mesh.lut_u = {0.25, 0.5, 0.75};
    scene.lights = table1::lights();
    scene.lut.axis = LutAxis(4, 12.0);
    scene.lut.base = {1, 0.5, 0.25, 0};
    return scene;
}

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

TEST(PovrayFiles, HoldTheMacrosAsTheyAre) {
    std::ifstream file(SKINGLOW_MACROS, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    ASSERT_GT(text.str().size(), 10000U);
    EXPECT_EQ(povray_macros(), text.str());
    EXPECT_EQ(povray_files(triangle()).at("skinglow.inc"), text.str());
}

TEST(PovrayFiles, SayWhatTheSceneHas) {
    const auto files = povray_files(triangle());
    EXPECT_TRUE(contains(files.at("lut.inc"), "Skinglow_Light_Count = 3;"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "{\n1, 0.5, 0.25, 0\n}"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "<0,0,0>, <1,0,1>)"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "<0,0,0>, <1,0,0>, <0,1,0>"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "<0.25,0.5>, <0.5,0.5>, <0.75,0.5>"));
    EXPECT_TRUE(contains(files.at("scene.ini"), "Width=512\nHeight=512\n"));
    EXPECT_FALSE(files.contains("lights.inc"));
}

TEST(PovrayFiles, CornerNormalsAndPictureCoordinatesAreWrittenOnceEach) {
    PovrayScene scene = triangle();
    scene.mesh.geometry = TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
    scene.mesh.lut_u.push_back(0.5);
    scene.mesh.corner_normals.assign(6, {0, 0, 1});
    scene.mesh.corner_normals[4] = {0, 0.6, 0.8};
    scene.mesh.corner_normals[5] = {0, 0, 0};  // as hosts give for triangles without area
    scene.mesh.surface_uv = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {-0.0, 1}};
    scene.surface = PovraySurface{.image = "skin.PNG"};
    const std::string mesh = povray_files(scene).at("mesh.inc");
    EXPECT_TRUE(contains(mesh, "normal_vectors { 3,\n<0,0,1>, <0,0.6,0.8>, <0,0,1>\n"));
    EXPECT_TRUE(contains(mesh, "normal_indices { 2,\n<0,0,0>, <0,1,2>\n"));
    EXPECT_TRUE(contains(mesh, "uv_vectors { 4,\n<0,0>, <1,0>, <0,1>, <1,1>\n"));
    EXPECT_TRUE(contains(mesh, "uv_indices { 2,\n<0,1,2>, <1,3,2>\n"));
    EXPECT_TRUE(
        contains(povray_files(scene).at("scene.pov"), "image_map { png \"skin.PNG\" interpolate 2 }"));
}

TEST(PovrayFiles, RefuseWhatPovrayCannotShow) {
    PovrayScene scene = triangle();
    scene.mesh.lut_u[1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.mesh.vertex_normals.resize(3);
    scene.mesh.corner_normals.resize(3);
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.lut.base.pop_back();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.lights[0].color.x = -1;
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene = triangle();
    scene.camera.window_max = scene.camera.window_min;
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
}

TEST(PovrayCamera, ProjectionAndFieldOfViewAgree) {
    // A perspective of 60 degrees, 2 : 1, shifted by a tenth of its width to the right and up, as OpenGL has
    // it.
    const double angle = std::numbers::pi / 3;
    const double x = 1 / std::tan(angle / 2);
    PovrayCamera by_matrix;
    by_matrix.width = 200;
    by_matrix.height = 100;
    PovrayCamera by_angle = by_matrix;
    glm::dmat4 projection(0.0);
    projection[0][0] = x;
    projection[1][1] = 2 * x;
    projection[2] = glm::dvec4(0.2, 0.4, -1.002, -1);
    projection[3][2] = -0.2;
    set_projection(by_matrix, projection);
    set_field_of_view(by_angle, angle, glm::dvec2(0.1));
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(by_matrix.window_min[k], by_angle.window_min[k], 1e-15);
        EXPECT_NEAR(by_matrix.window_max[k], by_angle.window_max[k], 1e-15);
    }
    EXPECT_EQ(by_matrix.projection, PovrayProjection::perspective);
    EXPECT_NEAR(by_angle.window_max.x - by_angle.window_min.x, 2 * std::tan(angle / 2), 1e-15);
}

TEST(PovrayCamera, OrthographicProjection) {
    PovrayCamera camera;
    camera.width = 100;
    camera.height = 200;
    PovrayCamera by_matrix = camera;
    set_orthographic(camera, 3.0, {0.25, 0});
    EXPECT_EQ(camera.window_min, glm::dvec2(0, -3));  // a quarter of the longer side, 6, to the right
    EXPECT_EQ(camera.window_max, glm::dvec2(3, 3));
    glm::dmat4 projection(1.0);
    projection[0][0] = 2.0 / 3.0;
    projection[1][1] = 1.0 / 3.0;
    projection[2][2] = -0.02;
    projection[3][0] = -1.0;
    set_projection(by_matrix, projection);
    EXPECT_EQ(by_matrix.projection, PovrayProjection::orthographic);
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(by_matrix.window_min[k], camera.window_min[k], 1e-15);
        EXPECT_NEAR(by_matrix.window_max[k], camera.window_max[k], 1e-15);
    }
}

TEST(SdlText, IdentifiersAreSafeAndDifferent) {
    EXPECT_EQ(sdl_identifier("Mesh", "u"), "Skinglow_Mesh_u");
    EXPECT_EQ(sdl_identifier("Mesh", "a b"), "Skinglow_Mesh_a_20_b");
    std::set<std::string> identifiers;
    for (const std::string name : {"", "_", "__", "a b", "a_b", "a_20_b", "\xc3\xa9"}) {
        identifiers.insert(sdl_identifier("Mesh", name));
    }
    identifiers.insert(sdl_identifier("Mesh", std::string(1000, 'a')));
    identifiers.insert(sdl_identifier("Mesh", std::string(1001, 'a')));
    EXPECT_EQ(identifiers.size(), 9U);
    for (const std::string& identifier : identifiers) {
        EXPECT_LT(identifier.size(), 150U);
        EXPECT_EQ(
            identifier.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_"),
            std::string::npos);
    }
}

TEST(SdlText, StringsAndCommentsCannotBreakOut) {
    EXPECT_EQ(sdl_string("name", "a\"b\\"), "\"a\\\"b\\\\\"");
    EXPECT_THROW(sdl_string("name", "a\nb"), std::invalid_argument);
    EXPECT_EQ(sdl_comment("a\n#error \xc3\xa9\\"), "a?#error ???");
}

TEST(SdlText, NumbersReadBackAsTheSame) {
    SdlText text;
    text.add(0.1 + 0.2).add(" ").add(-0.0).add(" ").add(1e-310).add(" ").add(glm::dvec3(1, 2.5, -3));
    EXPECT_EQ(text.take(), "0.30000000000000004 0 1e-310 <1,2.5,-3>");
}

TEST(GrayEntries, OfGrayBasesAlone) {
    EXPECT_EQ(gray_entries(BaseLut::from_gray(std::vector<double>{1, 0.5}, 1)),
              (std::vector<double>{1, 0.5}));
    glm::dmat3 tinted(1.0);
    tinted[1][0] = 0.1;
    EXPECT_THROW(gray_entries(BaseLut({tinted}, 1)), std::invalid_argument);
}

}  // namespace
