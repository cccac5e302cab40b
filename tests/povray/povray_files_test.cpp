#include <gtest/gtest.h>
#include <skinglow/lut.h>
#include <skinglow/povray.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "random_lights.h"
#include "table1.h"

using namespace skinglow;

namespace {

/// One triangle before the paper's three lights.
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

std::string file_text(const std::string& name) {
    std::ifstream file(std::string(SKINGLOW_MACROS) + "/" + name, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(PovrayFiles, HoldTheMacrosAsTheyAreInOneFile) {
    std::string whole = file_text("skinglow.inc");
    for (const std::string part :
         {"checks", "equations", "tables", "quadrature", "irradiance", "area", "lights", "textures"}) {
        const std::string include = "#include \"skinglow_" + part + ".inc\"\n";
        const std::string text = file_text("skinglow_" + part + ".inc");
        ASSERT_GT(text.size(), 1000U) << part;
        const std::size_t at = whole.find(include);
        ASSERT_NE(at, std::string::npos) << part;
        whole.replace(at, include.size(), text);
    }
    EXPECT_EQ(povray_macros(), whole);
    EXPECT_EQ(povray_files(triangle()).at("skinglow.inc"), whole);
}

TEST(PovrayFiles, SayWhatTheSceneHas) {
    const auto files = povray_files(triangle());
    EXPECT_TRUE(contains(files.at("lights.inc"), "Skinglow_Light(\"POINT\", <1,"));
    EXPECT_TRUE(contains(files.at("scene.pov"), "Skinglow_Light_Sources = 0;"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "{\n1, 0.5, 0.25, 0\n}"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "Skinglow_Listed_Weight(<0,0,0>, <1,0,1>)"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "<0,0,0>, <1,0,0>, <0,1,0>"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "<0.25,0.5>, <0.5,0.5>, <0.75,0.5>"));
    EXPECT_TRUE(contains(files.at("scene.ini"), "Width=512\nHeight=512\n"));
    EXPECT_FALSE(files.contains("columns.inc"));
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
    scene.camera.window_max = scene.camera.window_min;
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
}

/// The first word of a file that stands for no finite number.
std::string not_finite(const std::string& text) {
    std::istringstream words(text);
    std::string word;
    while (words >> word) {
        for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
        std::size_t begin = word.find_first_not_of("<,-{(");
        while (begin != std::string::npos) {
            const std::size_t end = word.find_first_of("<,>{}();", begin);
            const std::string number = word.substr(begin, end - begin);
            if (number == "inf" || number == "nan" || number == "-inf" || number == "-nan") return word;
            begin = end == std::string::npos ? end : word.find_first_not_of("<,>{}();", end);
        }
    }
    return "";
}

TEST(PovrayLights, AreFiniteForAnyLightThatIsAllowed) {
    ASSERT_EQ(not_finite("rgb <1,-inf,2>"), "<1,-inf,2>");
    ASSERT_EQ(not_finite("tightness -nan"), "-nan");
    RandomScene random(3);
    const auto sign = [&] { return random.decades(0.1, 10) < 1 ? -1.0 : 1.0; };
    const auto any_vector = [&](double low, double high) {
        return random.unit_vector() * random.decades(low, high);
    };
    for (int round = 0; round < 5000; ++round) {
        PovrayScene scene = triangle();
        scene.surface = PovraySurface{};
        FlatLight light;
        light.name = "extreme";
        light.kind = static_cast<LightKind>(round % 4);
        light.area_shape = round % 8 < 4 ? AreaShape::rectangle : AreaShape::ellipse;
        light.color = glm::dvec3(random.decades(1e-300, 1e300), 1, 0);
        light.power = sign() * random.decades(1e-300, round % 3 == 0 ? 1e300 : 1e6);
        light.position = any_vector(1e-300, round % 5 == 0 ? 1e307 : 1e10);
        light.direction = any_vector(1e-300, 1e300);
        light.tangent = round % 7 == 0 ? light.direction : any_vector(1e-300, 1e300);
        light.radius = random.decades(1e-300, 1e300);
        light.soft_falloff = round % 2 == 0;
        light.sun_angle = std::min(random.decades(1e-300, 10), std::numbers::pi);
        light.spot_angle = std::min(random.decades(1e-300, 10), std::numbers::pi);
        light.spot_blend = std::min(random.decades(1e-300, 10), 1.0);
        light.size_x = random.decades(1e-300, 1e300);
        light.size_y = round % 9 == 0 ? 0.0 : random.decades(1e-300, 1e300);
        light.spread = std::min(random.decades(round % 2 == 0 ? 1e-300 : 1e-6, 10), std::numbers::pi);
        scene.lights = {light};
        for (const auto& [name, text] : povray_files(scene)) {
            if (name == "skinglow.inc") continue;
            ASSERT_EQ(not_finite(text), "") << name << " of round " << round;
        }
    }
}

TEST(PovrayLights, OfAnyLengthOfDirectionAreTheSame) {
    const auto lights_of = [](const Light& light) {
        PovrayScene scene = triangle();
        scene.surface = PovraySurface{};
        scene.lights = {light};
        return povray_files(scene).at("lights.inc");
    };
    FlatLight light;
    light.kind = LightKind::spot;
    light.position = {1, 2, 3};
    light.direction = {0, 0, -1};
    for (const LightKind kind : {LightKind::spot, LightKind::area, LightKind::sun}) {
        light.kind = kind;
        light.direction = {0, 0, -1};
        const std::string wanted = lights_of(light);
        for (const double length : {1e-170, 1e-300, 1e200, 1e300}) {
            light.direction = {0, 0, -length};
            EXPECT_EQ(lights_of(light), wanted) << length;
        }
    }
}

TEST(PovrayFiles, OfModePhysicalHoldTheColumns) {
    PovrayScene scene = triangle();
    scene.lut.mode = LutMode::physical;
    scene.lut.axis = LutAxis(1, 12.0);
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene.lut.matrices = {glm::dmat3(1, 2, 3, 4, 5, 6, 7, 8, 9)};
    scene.lut.world_irradiance = {0.5, 0.25, 0};
    const auto files = povray_files(scene);
    EXPECT_TRUE(contains(files.at("columns.inc"), "Skinglow_Green_Column = array[1] {\n<4,5,6>\n}"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "Skinglow_Listed_Irradiance(<0,0,0>) + <0.5,0.25,0>;"));
    scene.lut.world_irradiance.x = std::numeric_limits<double>::infinity();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
}

TEST(PovrayFiles, OfAnAnimationSayFramesAndClock) {
    PovrayScene scene = triangle();
    EXPECT_FALSE(contains(povray_files(scene).at("scene.ini"), "Frame"));
    scene.frames = PovrayFrames{5, 30, 25};
    EXPECT_TRUE(contains(povray_files(scene).at("scene.ini"),
                         "Initial_Frame=5\nFinal_Frame=30\nInitial_Clock=0\nFinal_Clock=1\n"));
    for (const PovrayFrames& wrong :
         {PovrayFrames{-1, 3, 25}, PovrayFrames{3, 2, 25}, PovrayFrames{1, 2, 0}}) {
        scene.frames = wrong;
        EXPECT_THROW(povray_files(scene), std::invalid_argument);
    }
    EXPECT_THROW(povray_frame_choice({}), std::invalid_argument);
    const std::vector<PovrayFrameFile> twice = {{3, "a.inc"}, {3, "b.inc"}};
    EXPECT_THROW(povray_frame_choice(twice), std::invalid_argument);
}

TEST(PovrayFiles, ShowTheMeshAtEachOfItsPlaces) {
    PovrayScene scene = triangle();
    glm::dmat4 place(1.0);
    place[0] = {0, 2, 0, 0};
    place[1] = {-2, 0, 0, 0};
    place[3] = {5, 6, 7, 1};
    scene.mesh.instances = {place};
    const std::string text = povray_files(scene).at("scene.pov");
    EXPECT_TRUE(contains(text, "object { Skinglow_Mesh_skin matrix <0,2,0, -2,0,0, 0,0,1, 5,6,7> }"));
    scene.mesh.instances[0][2] = glm::dvec4(0.0);
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene.mesh.instances[0][2].z = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
}

TEST(PovrayFiles, WithAThicknessPictureAreOneRender) {
    PovrayScene scene = triangle();
    scene.mesh.lut_u.clear();
    scene.mesh.surface_uv = {{0, 0}, {1, 0}, {0, 1}};
    scene.surface = PovraySurface{.image = "skin.png"};
    scene.lut.thickness = PovrayThicknessPicture{"mm.png", 0.0, 8.0};
    const auto files = povray_files(scene);
    EXPECT_FALSE(contains(files.at("scene.pov"), "Skinglow_Part"));
    EXPECT_TRUE(contains(files.at("mesh.inc"), "uv_vectors { 3,\n<0,0>, <1,0>, <0,1>\n"));
    EXPECT_TRUE(contains(files.at("lut.inc"), "Skinglow_Picture_Thickness(\"mm.png\", 0, 8)"));
    scene.lut.thickness->file = "mm.jpg";
    EXPECT_THROW(povray_files(scene), std::invalid_argument);
    scene.lut.thickness->file = "mm.exr";
    scene.lut.glow = PovrayGlow::image;
    scene.lut.image = "lut.exr";
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

TEST(GrayEntries, OfGrayBasesAlone) {
    EXPECT_EQ(gray_entries(BaseLut::from_gray(std::vector<double>{1, 0.5}, 1)),
              (std::vector<double>{1, 0.5}));
    glm::dmat3 tinted(1.0);
    tinted[1][0] = 0.1;
    EXPECT_THROW(gray_entries(BaseLut({tinted}, 1)), std::invalid_argument);
}

}  // namespace
