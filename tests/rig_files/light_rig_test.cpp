#include "rig_files/light_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "light/light_fields.h"
#include "random_lights.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "table1.h"

namespace skinglow::test {
namespace {

/// Every field of a light that its kind has, by key.
std::map<std::string, std::vector<double>> values_of(const Light& light) {
    std::map<std::string, std::vector<double>> values{{"kind", {static_cast<double>(light.kind())}}};
    for_each_field(light.settings(), [&](const auto& field, const auto& owner) {
        const auto& value = owner.*field.member;
        std::vector<double>& numbers = values[std::string(field.key)];
        if constexpr (requires { value.x; }) {
            numbers = {value.x, value.y, value.z};
        } else if constexpr (requires { value.size(); }) {
            numbers.assign(value.begin(), value.end());
        } else {
            numbers = {static_cast<double>(value)};
        }
    });
    return values;
}

void expect_same(const LightRig& rig, const LightRig& expected) {
    EXPECT_EQ(rig.name, expected.name);
    EXPECT_EQ(rig.point, expected.point);
    EXPECT_EQ(rig.coefficients.constant, expected.coefficients.constant);
    EXPECT_EQ(rig.coefficients.linear, expected.coefficients.linear);
    EXPECT_EQ(rig.coefficients.quadratic, expected.coefficients.quadratic);
    EXPECT_EQ(rig.blood_weight, expected.blood_weight);
    ASSERT_EQ(rig.lights.size(), expected.lights.size());
    for (std::size_t i = 0; i < rig.lights.size(); ++i) {
        SCOPED_TRACE(expected.lights[i].name());
        EXPECT_EQ(values_of(rig.lights[i]), values_of(expected.lights[i]));
    }
}

TEST(LightRig, Table1HasThePapersColorsDistancesAndWeights) {
    const LightRig rig = read_light_rig(data_file("table1.json"));
    ASSERT_EQ(rig.lights.size(), 3U);
    EXPECT_EQ(rig.blood_weight, paper_blood_weight);
    EXPECT_EQ(rig.lights[0].color(), glm::dvec3(255, 112, 69) / 255.0);
    EXPECT_EQ(rig.lights[1].color(), glm::dvec3(15, 64, 255) / 255.0);
    EXPECT_EQ(rig.lights[2].color(), glm::dvec3(1.0));
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
    const auto& ball = std::get<PointLight>(rig.lights[0].shape());
    EXPECT_EQ(ball.radius, 0.05);
    EXPECT_FALSE(ball.soft_falloff);
    EXPECT_EQ(std::get<SunLight>(rig.lights[1].shape()).sun_angle, 0.009);
    const auto& spot = std::get<SpotLight>(rig.lights[2].shape());
    EXPECT_EQ(spot.spot_angle, 0.8);
    EXPECT_EQ(spot.spot_blend, 0.3);
    EXPECT_TRUE(spot.spot_cosine);
    const auto& area = std::get<AreaLight>(rig.lights[3].shape());
    EXPECT_EQ(area.area_shape, AreaShape::ellipse);
    EXPECT_EQ(area.size_x, 0.5);
    EXPECT_EQ(area.size_y, 0.25);
    EXPECT_EQ(area.tangent, glm::dvec3(1, -1, 0));
    EXPECT_EQ(area.spread, 2.0);
    EXPECT_FALSE(rig.lights[4].visible());
}

TEST(LightRig, RoundTripIsExact) {
    const ScratchFolder folder;
    for (const char* name : {"table1.json", "all_kinds.json"}) {
        LightRig rig = read_light_rig(data_file(name));
        LightSettings first = rig.lights[0].settings();
        first.color = {1.0 / 3.0, 1e-308, 1e300};
        first.name = "Lämpchen \"1\"";
        rig.lights[0] = first;
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
        rig.lights.emplace_back(LightSettings{.position = {0.1 * i, 1.0 / (1 + i), -7.0}});
    }
    write_light_rig(folder / "a.json", rig);
    const LightRig read = read_light_rig(folder / "a.json");
    ASSERT_EQ(read.lights.size(), 10000U);
    EXPECT_EQ(read.lights[9999].position(), rig.lights[9999].position());
}

TEST(LightRig, EveryValidRigReadsBackEqual) {
    const ScratchFolder folder;
    RandomScene random(21);
    // A range's ends, and pi as a host's single precision has it.
    const auto edge = [&](double inner, double end) { return random.one_in(2) ? inner : end; };
    constexpr double float_pi = 3.1415927410125732;
    for (int trial = 0; trial < 60; ++trial) {
        LightRig rig;
        rig.name = random.one_in(2) ? "" : "Häuschen \"\\\n\t";
        rig.point = random.unit_vector() * random.decades(1e-300, 1e300);
        rig.coefficients = {random.decades(1e-308, 1e308), edge(1.0 / 3.0, 0.0), random.decades(1e-3, 1e3)};
        rig.blood_weight = random.in_box(glm::dvec3(0.0), glm::dvec3(2.0));
        for (int i = 0; i < 20; ++i) {
            FlatLight light = random.light();
            light.name = random.one_in(2) ? "" : "Lamp\u00e9 " + std::to_string(i);
            light.visible = random.one_in(2);
            light.power = edge(-random.decades(1e-308, 1e308), 0.0);
            light.position *= edge(1.0, 1e300);
            light.radius = edge(light.radius, std::numeric_limits<double>::max());
            light.sun_angle = edge(light.sun_angle, float_pi);
            light.spot_angle = edge(light.spot_angle, float_pi);
            light.spot_blend = edge(light.spot_blend, 1.0);
            light.size_x = edge(light.size_x, std::numeric_limits<double>::denorm_min());
            light.tangent *= edge(1.0, 0.0);
            light.spread = edge(light.spread, float_pi);
            rig.lights.emplace_back(light);
        }
        write_light_rig(folder / "a.json", rig);
        expect_same(read_light_rig(folder / "a.json"), rig);
    }
}

TEST(LightRig, OneTableSaysWhatALightMayBe) {
    // Just beyond a range the light itself, and the reader by key, refuse.
    const double beyond = std::nextafter(double{std::numbers::pi_v<float>}, 4.0);
    for (const double angle : {-1e-300, beyond}) {
        expect_refused<std::invalid_argument>([&] { Light({.shape = SunLight{angle}}); },
                                              {"sun_angle", "0 to pi"});
        expect_refused<std::invalid_argument>([&] { Light({.shape = AreaLight{.spread = angle}}); },
                                              {"spread", "0 to pi"});
    }
    const ScratchFolder folder;
    folder.write("a.json", R"({"skinglow_rig": 1, "lights": [{"kind": "AREA", "spread": 3.15}]})");
    expect_refused<FileError>([&] { read_light_rig(folder / "a.json"); }, {"lights[0].spread", "3.15"});
}

TEST(LightRig, SchemaSaysWhatTheTableSays) {
    std::ifstream file(SKINGLOW_SCHEMA);
    const auto schema = nlohmann::json::parse(file);
    const auto& light = schema.at("definitions").at("light");
    const auto& keys = light.at("properties");
    std::set<std::string> expected = {"kind", "color_bytes"};
    std::map<std::string, std::set<std::string>> kinds_with;
    for (const LightKind kind : {LightKind::point, LightKind::sun, LightKind::spot, LightKind::area}) {
        LightSettings settings;
        settings.shape = default_shape(kind);
        for_each_field(settings, [&](const auto& field, const auto& owner) {
            const std::string key(field.key);
            expected.insert(key);
            kinds_with[key].insert(std::string(to_text(kind)));
            const std::string about = keys.at(key).dump();
            using Value = std::remove_cvref_t<decltype(owner.*field.member)>;
            if constexpr (std::is_same_v<Value, double>) {
                const auto& entry = keys.at(key);
                const auto& numbers = entry.contains("$ref")
                                          ? schema.at(nlohmann::json::json_pointer(
                                                entry.at("$ref").get<std::string>().substr(1)))
                                          : entry;
                EXPECT_EQ(numbers.at("type"), "number") << key;
                const Limits range = limits(field.range);
                EXPECT_EQ(numbers.value("minimum", -largest_double), range.min) << key;
                EXPECT_EQ(numbers.value("maximum", largest_double), range.max) << key;
            } else if constexpr (std::is_same_v<Value, bool>) {
                EXPECT_EQ(about, R"({"type":"boolean"})") << key;
            } else if constexpr (std::is_same_v<Value, glm::dvec3>) {
                EXPECT_NE(about.find(field.range == FieldRange::not_negative ? "color" : "vector"),
                          std::string::npos)
                    << key;
            }
        });
    }
    std::set<std::string> found;
    for (const auto& [key, entry] : keys.items()) found.insert(key);
    EXPECT_EQ(found, expected);
    // Keys that a kind does not have are refused by an "if" on the kinds that have them not.
    std::map<std::string, std::set<std::string>> kinds_without;
    for (const auto& rule : light.at("allOf")) {
        if (!rule.contains("then")) continue;
        for (const auto& [key, entry] : rule.at("then").at("properties").items()) {
            for (const auto& kind : rule.at("if").at("properties").at("kind").at("enum"))
                kinds_without[key].insert(kind.get<std::string>());
        }
    }
    for (const auto& [key, with] : kinds_with) EXPECT_EQ(with.size() + kinds_without[key].size(), 4U) << key;
}

TEST(LightRig, RefusesToWriteWhatItWouldRefuseToRead) {
    const ScratchFolder folder;
    LightRig rig;
    rig.blood_weight.g = std::numeric_limits<double>::infinity();
    expect_refused<std::invalid_argument>([&] { write_light_rig(folder / "a.json", rig); },
                                          {"blood_weight", "inf"});
    EXPECT_TRUE(folder.names().empty());
    expect_refused<FileError>([&] { write_light_rig("/proc/a.json", LightRig{}); },
                              {"/proc/a.json", "cannot be written"});
}

}  // namespace
}  // namespace skinglow::test
