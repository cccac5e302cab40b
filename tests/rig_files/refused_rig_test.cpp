#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "random_lights.h"
#include "rig_files/file_error.h"
#include "rig_files/light_rig.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

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
