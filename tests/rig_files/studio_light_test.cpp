#include "rig_files/studio_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "rig_files/file_error.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

/// Blender's own rim.sl, from Debian's package or where the variable SKINGLOW_RIM_SL says.
std::filesystem::path find_rim() {
    if (const char* given = std::getenv("SKINGLOW_RIM_SL")) return given;
    return "/usr/share/blender/datafiles/studiolights/studio/rim.sl";
}

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = read_bytes(data_file("two_lamps.sl"));
    const std::size_t found = text.find(from);
    if (found == std::string::npos) throw std::runtime_error("no " + from);
    return text.replace(found, from.size(), to);
}

TEST(StudioLight, LightsBecomeSunsInWorldAxes) {
    const StudioLight studio = read_studio_light(data_file("two_lamps.sl"));
    ASSERT_EQ(studio.lights.size(), 2U) << "lights with flag 0 are off";
    const Light& rim = studio.lights[0];
    EXPECT_EQ(rim.kind(), LightKind::sun);
    EXPECT_EQ(rim.name(), "light[0]");
    EXPECT_EQ(rim.color(), glm::dvec3(0.9, 0.45, 0.1));
    // Towards the light: right and away from the viewer (view z -0.8), so world (0.6, 0.8, 0); it shines the
    // other way.
    EXPECT_EQ(rim.direction(), glm::dvec3(-0.6, -0.8, 0.0));
    EXPECT_EQ(studio.lights[1].name(), "light[2]");
    EXPECT_EQ(studio.lights[1].direction(), glm::dvec3(0.0, 0.0, -1.0)) << "from above, straight down";
    EXPECT_NEAR(studio.lights[1].power(), 3.141592653589793, 1e-15);
    for (const Light& light : studio.lights) EXPECT_EQ(light.kind(), LightKind::sun);
}

TEST(StudioLight, SaysWhatASunCannotHold) {
    const StudioLight studio = read_studio_light(data_file("two_lamps.sl"));
    ASSERT_EQ(studio.notes.size(), 2U);
    EXPECT_NE(studio.notes[0].find("ambient"), std::string::npos);
    EXPECT_NE(studio.notes[1].find("smooth"), std::string::npos);
}

TEST(StudioLight, FollowsTheCamera) {
    // A camera at +X that looks along -X: Blender's right view, rotation (90, 0, 90) degrees; its right is
    // +Y.
    const double quarter = std::acos(0.0);
    const StudioLight studio =
        read_studio_light(data_file("two_lamps.sl"), camera_axes({quarter, 0.0, quarter}));
    const glm::dvec3 expected(0.8, -0.6,
                              0.0);  // towards the light: 0.6 right (+Y), 0.8 away from the viewer (-X)
    EXPECT_NEAR(glm::distance(studio.lights[0].direction(), expected), 0.0, 1e-15);
    const glm::dmat3 front = camera_axes({quarter, 0.0, 0.0});
    for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(glm::distance(front[column], front_view[column]), 0.0, 1e-15);
    // Blender's order is X, then Y, then Z about the world's axes: (90, 90, 0) turns view z (+Z, then -Y) to
    // stay at -Y and view x (+X) to -Z.
    const glm::dmat3 turned = camera_axes({quarter, quarter, 0.0});
    EXPECT_NEAR(glm::distance(turned[2], glm::dvec3(0, -1, 0)), 0.0, 1e-15);
    EXPECT_NEAR(glm::distance(turned[0], glm::dvec3(0, 0, -1)), 0.0, 1e-15);
}

TEST(StudioLight, RefusesACameraThatIsNone) {
    const auto path = data_file("two_lamps.sl");
    expect_refused<std::invalid_argument>([&] { read_studio_light(path, glm::dmat3(2.0)); },
                                          {"camera", "perpendicular"});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refused<std::invalid_argument>([&] { read_studio_light(path, glm::dmat3(nan)); }, {"camera"});
    expect_refused<std::invalid_argument>([&] { camera_axes({nan, 0, 0}); }, {"camera rotation"});
}

TEST(StudioLight, BlendersRimIsTwoLightsFromBehindAndOneFromTheFront) {
    const auto path = find_rim();
    ASSERT_TRUE(std::filesystem::exists(path))
        << path << " is missing; Debian's blender-data has it, or SKINGLOW_RIM_SL names another";
    const StudioLight studio = read_studio_light(path);
    ASSERT_EQ(studio.lights.size(), 3U);
    EXPECT_GT(studio.lights[0].color().r, studio.lights[2].color().r);
    // The camera looks along +Y, so what comes from behind the head shines along -Y.
    EXPECT_LT(studio.lights[0].direction().y, 0.0);
    EXPECT_GT(studio.lights[1].direction().y, 0.0);
    EXPECT_LT(studio.lights[2].direction().y, 0.0);
    EXPECT_GT(studio.lights[0].direction().x, 0.0) << "from the viewer's left";
    EXPECT_LT(studio.lights[2].direction().x, 0.0);
    for (const Light& light : studio.lights) EXPECT_NEAR(glm::length(light.direction()), 1.0, 1e-3);
}

TEST(StudioLight, RefusesDamagedFilesAndNamesKeyAndLine) {
    const ScratchFolder folder;
    const auto expect_bad = [&](const std::string& text, const std::vector<std::string>& parts) {
        folder.write("bad.sl", text);
        expect_refused<FileError>([&] { read_studio_light(folder / "bad.sl"); }, parts);
    };
    const std::string whole = read_bytes(data_file("two_lamps.sl"));
    expect_bad("", {"bad.sl", "key version", "missing"});
    expect_bad("{}", {"line 1", "no key"});
    expect_bad(replaced("version 1", "version 2"), {"key version", "is 2", "version 1"});
    expect_bad(whole.substr(0, whole.find("light[3].vec.y")), {"key light[3].vec.y", "missing"});
    expect_bad(replaced("light[0].col.x 0.900000", "light[0].col.x -0.9"), {"key light[0].col", "-0.9"});
    expect_bad(replaced("light[0].col.x 0.900000", "light[0].col.x nan"), {"line 7", "finite"});
    expect_bad(replaced("light[0].col.x 0.900000", "light[0].col.x"), {"line 7"});
    expect_bad(replaced("light[0].col.x 0.900000", "light[0].col.y 0.9"), {"line 8", "second time"});
    expect_bad(replaced("light[2].vec.y 1.000000", "light[2].vec.y 0.0"), {"key light[2].vec", "length 0"});
    expect_refused<FileError>([&] { read_studio_light(folder / "none.sl"); }, {"none.sl", "No such file"});
}

}  // namespace
}  // namespace skinglow::test
