#include "rig_files/light_rig.h"

#include <gtest/gtest.h>

#include <limits>

#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "table1.h"

namespace skinglow::test {
namespace {

void expect_same(const LightRig& rig, const LightRig& expected) {
    EXPECT_EQ(rig.name, expected.name);
    EXPECT_EQ(rig.point, expected.point);
    EXPECT_EQ(rig.coefficients.constant, expected.coefficients.constant);
    EXPECT_EQ(rig.coefficients.linear, expected.coefficients.linear);
    EXPECT_EQ(rig.coefficients.quadratic, expected.coefficients.quadratic);
    EXPECT_EQ(rig.blood_weight, expected.blood_weight);
    ASSERT_EQ(rig.lights.size(), expected.lights.size());
    for (std::size_t i = 0; i < rig.lights.size(); ++i) {
        SCOPED_TRACE(expected.lights[i].name);
        const Light& light = rig.lights[i];
        const Light& other = expected.lights[i];
        EXPECT_EQ(light.kind, other.kind);
        EXPECT_EQ(light.color, other.color);
        EXPECT_EQ(light.position, other.position);
        EXPECT_EQ(light.direction, other.direction);
        EXPECT_EQ(light.power, other.power);
        EXPECT_EQ(light.name, other.name);
        EXPECT_EQ(light.visible, other.visible);
        EXPECT_EQ(light.radius, other.radius);
        EXPECT_EQ(light.soft_falloff, other.soft_falloff);
        EXPECT_EQ(light.sun_angle, other.sun_angle);
        EXPECT_EQ(light.spot_angle, other.spot_angle);
        EXPECT_EQ(light.spot_blend, other.spot_blend);
        EXPECT_EQ(light.spot_cosine, other.spot_cosine);
        EXPECT_EQ(light.area_shape, other.area_shape);
        EXPECT_EQ(light.size_x, other.size_x);
        EXPECT_EQ(light.size_y, other.size_y);
        EXPECT_EQ(light.tangent, other.tangent);
        EXPECT_EQ(light.spread, other.spread);
    }
}

TEST(LightRig, Table1HasThePapersColorsDistancesAndWeights) {
    const LightRig rig = read_light_rig(data_file("table1.json"));
    ASSERT_EQ(rig.lights.size(), 3U);
    EXPECT_EQ(rig.blood_weight, paper_blood_weight);
    EXPECT_EQ(rig.lights[0].color, glm::dvec3(255, 112, 69) / 255.0);
    EXPECT_EQ(rig.lights[1].color, glm::dvec3(15, 64, 255) / 255.0);
    EXPECT_EQ(rig.lights[2].color, glm::dvec3(1.0));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(light_distance(rig.lights[i], rig.point), table1::distance[i], 1e-15);
    }
    const glm::dvec3 weight = light_weight(rig.lights, rig.point, rig.coefficients);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(weight[i], table1::total[i], 1e-12);
}

TEST(LightRig, ReadsEveryKey) {
    const LightRig rig = read_light_rig(data_file("all_kinds.json"));
    ASSERT_EQ(rig.lights.size(), 5U);
    EXPECT_EQ(rig.point, glm::dvec3(0.1, -0.2, 0.3));
    EXPECT_EQ(rig.coefficients.linear, 0.25);
    EXPECT_EQ(rig.lights[0].radius, 0.05);
    EXPECT_FALSE(rig.lights[0].soft_falloff);
    EXPECT_EQ(rig.lights[1].kind, LightKind::sun);
    EXPECT_EQ(rig.lights[1].sun_angle, 0.009);
    EXPECT_EQ(rig.lights[2].spot_angle, 0.8);
    EXPECT_EQ(rig.lights[2].spot_blend, 0.3);
    EXPECT_TRUE(rig.lights[2].spot_cosine);
    EXPECT_EQ(rig.lights[3].area_shape, AreaShape::ellipse);
    EXPECT_EQ(rig.lights[3].size_x, 0.5);
    EXPECT_EQ(rig.lights[3].size_y, 0.25);
    EXPECT_EQ(rig.lights[3].tangent, glm::dvec3(1, -1, 0));
    EXPECT_EQ(rig.lights[3].spread, 2.0);
    EXPECT_FALSE(rig.lights[4].visible);
}

TEST(LightRig, RoundTripIsExact) {
    const ScratchFolder folder;
    for (const char* name : {"table1.json", "all_kinds.json"}) {
        LightRig rig = read_light_rig(data_file(name));
        rig.lights[0].color = {1.0 / 3.0, 1e-308, 1e300};
        rig.lights[0].name = "Lämpchen \"1\"";
        write_light_rig(folder / "a.json", rig);
        expect_same(read_light_rig(folder / "a.json"), rig);
    }
    LightRig none;
    write_light_rig(folder / "none.json", none);
    expect_same(read_light_rig(folder / "none.json"), none);
}

TEST(LightRig, TenThousandLightsRoundTrip) {
    const ScratchFolder folder;
    LightRig rig;
    for (int i = 0; i < 10000; ++i) {
        Light light;
        light.position = {0.1 * i, 1.0 / (1 + i), -7.0};
        rig.lights.push_back(light);
    }
    write_light_rig(folder / "a.json", rig);
    const LightRig read = read_light_rig(folder / "a.json");
    ASSERT_EQ(read.lights.size(), 10000U);
    EXPECT_EQ(read.lights[9999].position, rig.lights[9999].position);
}

TEST(LightRig, RefusesToWriteWhatItWouldRefuseToRead) {
    const ScratchFolder folder;
    LightRig rig;
    rig.blood_weight.g = std::numeric_limits<double>::infinity();
    expect_refused<std::invalid_argument>([&] { write_light_rig(folder / "a.json", rig); },
                                          {"blood_weight", "inf"});
    rig = {};
    rig.lights.resize(1);
    rig.lights[0].color.r = -1.0;
    expect_refused<std::invalid_argument>([&] { write_light_rig(folder / "a.json", rig); }, {"color", "-1"});
    EXPECT_TRUE(folder.names().empty());
    expect_refused<FileError>([&] { write_light_rig("/proc/a.json", LightRig{}); },
                              {"/proc/a.json", "cannot be written"});
}

struct BadRig {
    const char* what;
    std::string text;
    std::vector<std::string> parts;
};

class RefusedRig : public testing::TestWithParam<BadRig> {};

TEST_P(RefusedRig, NamesFileKeyAndLine) {
    const ScratchFolder folder;
    folder.write("bad.json", GetParam().text);
    std::vector<std::string> parts = GetParam().parts;
    parts.emplace_back("bad.json");
    expect_refused<FileError>([&] { read_light_rig(folder / "bad.json"); }, parts);
}

/// A rig whose one light, on line 4 and after, has these further keys.
std::string with_light(const std::string& keys, const std::string& kind = "POINT") {
    return "{\"skinglow_rig\": 1,\n \"lights\": [\n  {\n   \"kind\": \"" + kind + "\",\n" + keys +
           "\n  }\n ]\n}\n";
}

std::string name_of(const testing::TestParamInfo<BadRig>& rig) {
    return rig.param.what;
}

INSTANTIATE_TEST_SUITE_P(
    Rigs, RefusedRig,
    testing::Values(
        BadRig{"empty", "", {"line 1", "not JSON"}}, BadRig{"text", "Dear friend", {"line 1", "not JSON"}},
        BadRig{"list", "[]", {"line 1", "a list of 0", "object"}},
        BadRig{"number", "\n\n7", {"line 3", "is 7"}},
        BadRig{"other_json", "{\"name\": \"a\"}", {"skinglow_rig", "missing"}},
        BadRig{"version", "{\n\"skinglow_rig\": 2,\n\"lights\": []}", {"key skinglow_rig (line 2)", "is 2"}},
        BadRig{"no_lights", "{\"skinglow_rig\": 1}", {"key lights", "missing"}},
        BadRig{"lights_object", "{\"skinglow_rig\": 1,\n\"lights\": {}}", {"key lights (line 2)", "list"}},
        BadRig{
            "light_number", "{\"skinglow_rig\": 1,\n\"lights\": [\n4]}", {"key lights[0] (line 3)", "is 4"}},
        BadRig{"unknown_top",
               "{\"skinglow_rig\": 1, \"lights\": [],\n\n\"lamps\": []}",
               {"key lamps (line 3)", "keys are"}},
        BadRig{
            "unknown_light", with_light("\"colour\": [1, 1, 1]"), {"key lights[0].colour (line 5)", "color"}},
        BadRig{"not_of_kind", with_light("\"spot_angle\": 1"), {"key lights[0].spot_angle (line 5)"}},
        BadRig{"syntax",
               "{\"skinglow_rig\": 1,\n\"lights\": [\n{\"kind\": \"POINT\",}]}",
               {"line 3, column 18", "not JSON"}},
        BadRig{"truncated", with_light("\"power\": 1").substr(0, 70), {"line ", "not JSON", "end of input"}},
        BadRig{"twice", with_light("\"power\": 1,\n\"power\": 2"), {"key lights[0].power (line 6)", "twice"}},
        BadRig{"nan", with_light("\"power\": NaN"), {"line 5", "not JSON"}},
        BadRig{"overflow", with_light("\"power\":\n 1e999"), {"line 6", "overflow"}},
        BadRig{"text_power", with_light("\"power\": \"1\""), {"key lights[0].power (line 5)", "number"}},
        BadRig{"null_power", with_light("\"power\": null"), {"key lights[0].power (line 5)", "null"}},
        BadRig{"two_numbers",
               with_light("\"color\": [1, 2]"),
               {"key lights[0].color (line 5)", "a list of 2", "three"}},
        BadRig{"negative",
               with_light("\"color\": [1,\n-2, 3]"),
               {"key lights[0].color[1] (line 6)", "-2", "0 or more"}},
        BadRig{"text_in_list",
               with_light("\"position\": [1,\n2,\n\"z\"]"),
               {"key lights[0].position[2] (line 7)"}},
        BadRig{"blend",
               with_light("\"direction\": [1,0,0],\n\"spot_blend\": 1.5", "SPOT"),
               {"key lights[0].spot_blend (line 6)", "1.5", "0 to 1"}},
        BadRig{"no_direction",
               with_light("\"direction\": [0,0,0]", "SUN"),
               {"key lights[0].direction (line 5)", "length 0"}},
        BadRig{"shape",
               with_light("\"area_shape\": \"STAR\"", "AREA"),
               {"key lights[0].area_shape (line 5)", "STAR", "ELLIPSE"}},
        BadRig{"visible", with_light("\"visible\": 1"), {"key lights[0].visible (line 5)", "true or false"}},
        BadRig{"name", with_light("\"name\": 5"), {"key lights[0].name (line 5)", "text"}},
        BadRig{"both_colors",
               with_light("\"color\": [1,1,1],\n\"color_bytes\": [1,1,1]"),
               {"color_bytes (line 6)", "one of the two"}},
        BadRig{"byte",
               with_light("\"color_bytes\": [1,256,1]"),
               {"lights[0].color_bytes[1] (line 5)", "0 to 255"}},
        BadRig{"coefficient",
               "{\"skinglow_rig\": 1, \"lights\": [],\n\"attenuation\": {\"constant\": 1,\n\"linear\": -1}}",
               {"key attenuation.linear (line 3)", "-1"}},
        BadRig{"coefficient_key",
               "{\"skinglow_rig\": 1, \"lights\": [],\n\"attenuation\": {\"cubic\": 1}}",
               {"key attenuation.cubic (line 2)"}},
        BadRig{"blood",
               "{\"skinglow_rig\": 1, \"lights\": [],\n\"blood_weight\": [1, 1, -1]}",
               {"key blood_weight[2] (line 2)"}},
        BadRig{"deep", std::string(100, '['), {"deeper"}}),
    name_of);

TEST(LightRig, RefusesTheKindByItsKey) {
    const ScratchFolder folder;
    folder.write("a.json", with_light("\"power\": 1", "LASER"));
    expect_refused<FileError>([&] { read_light_rig(folder / "a.json"); },
                              {"key lights[0].kind (line 4)", "LASER", "SPOT"});
    folder.write("b.json", "{\"skinglow_rig\": 1, \"lights\": [\n{\"power\": 1}]}");
    expect_refused<FileError>([&] { read_light_rig(folder / "b.json"); }, {"key lights[0].kind", "missing"});
}

TEST(LightRig, RefusesFilesThatCannotBeRead) {
    const ScratchFolder folder;
    expect_refused<FileError>([&] { read_light_rig(folder / "none.json"); }, {"none.json", "No such file"});
    expect_refused<FileError>([&] { read_light_rig(folder.path()); }, {"is a folder"});
}

}  // namespace
}  // namespace skinglow::test
