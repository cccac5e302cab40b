#include <algorithm>
#include <string>
#include <vector>

#include "light/light_fields.h"
#include "numerics/argument_check.h"
#include "rig_files/light_rig.h"
#include "rig_files/located_json.h"

namespace skinglow::detail {
namespace {

using nlohmann::json;

constexpr int rig_version = 1;

/// "a, b or c"
std::string alternatives(const std::vector<std::string_view>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += names[i];
    }
    return text;
}

/// Short text of a value for a message.
std::string shown(const json& value) {
    if (value.is_array()) return "a list of " + std::to_string(value.size());
    if (value.is_object()) return "an object";
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    constexpr std::size_t longest = 60;
    if (text.size() > longest) text = text.substr(0, longest) + "...";
    return text;
}

/// One object of the file and its name, with typed access to its keys.
class ObjectReader {
  public:
    ObjectReader(const LocatedJson& file, const json& object, std::string name)
        : file_(file), object_(object), name_(std::move(name)) {
        if (!object.is_object()) file.refuse(name_, "is " + shown(object), "give an object {...}");
    }

    std::string key_name(std::string_view key) const {
        return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
    }

    const json* find(std::string_view key) const {
        const auto found = object_.find(std::string(key));
        return found == object_.end() ? nullptr : &*found;
    }

    [[noreturn]] void refuse(std::string_view key, const std::string& what, std::string_view remedy) const {
        file_.refuse(key_name(key), what, remedy);
    }

    void allow_only(const std::vector<std::string_view>& keys) const {
        for (const auto& [key, value] : object_.items()) {
            if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
                refuse(key, "is not a key of the format here", "keys are " + alternatives(keys));
            }
        }
    }

    /// The value of a key into what `into` is, if the key is there.
    template <typename Value>
    void read(std::string_view key, Value& into, const Limits& limits = {}) const {
        if (const json* value = find(key)) take(*value, key, into, limits);
    }

    /// What a text names, by a function that throws std::invalid_argument on a name it does not know.
    template <typename Value>
    Value named(std::string_view key, Value (*value_of)(std::string_view), std::string_view remedy) const {
        std::string text;
        read(key, text);
        try {
            return value_of(text);
        } catch (const std::invalid_argument&) {
            refuse(key, "is \"" + text + "\"", remedy);
        }
    }

  private:
    void take(const json& value, std::string_view key, double& into, const Limits& limits) const {
        into = number(value, key_name(key), limits);
    }

    void take(const json& value, std::string_view key, glm::dvec3& into, const Limits& limits) const {
        if (!value.is_array() || value.size() != 3)
            refuse(key, "is " + shown(value), "give a list of three numbers");
        for (int i = 0; i < 3; ++i) {
            into[i] = number(value[static_cast<std::size_t>(i)],
                             key_name(key) + "[" + std::to_string(i) + "]", limits);
        }
    }

    void take(const json& value, std::string_view key, bool& into, const Limits& /*limits*/) const {
        if (!value.is_boolean()) refuse(key, "is " + shown(value), "give true or false");
        into = value.get<bool>();
    }

    void take(const json& value, std::string_view key, std::string& into, const Limits& /*limits*/) const {
        if (!value.is_string()) refuse(key, "is " + shown(value), "give a text in quotes");
        into = value.get<std::string>();
    }

    void take(const json& /*value*/, std::string_view key, AreaShape& into, const Limits& /*limits*/) const {
        into = named(key, area_shape, "give RECTANGLE, SQUARE, ELLIPSE or DISK");
    }

    double number(const json& value, const std::string& name, const Limits& limits) const {
        std::string allowed = "give a number";
        if (limits.min == 0.0)
            allowed += limits.max == largest_double ? ", 0 or more" : " of 0 to " + to_text(limits.max);
        const double found = value.is_number() ? value.get<double>() : limits.max;
        if (!value.is_number() || found < limits.min || found > limits.max)
            file_.refuse(name, "is " + shown(value), allowed);
        return found;
    }

    const LocatedJson& file_;
    const json& object_;
    std::string name_;
};

std::vector<std::string_view> keys_of(const LightSettings& light) {
    std::vector<std::string_view> keys = {"kind", "color_bytes"};
    for_each_field(light, [&](const auto& field, const auto& /*owner*/) { keys.push_back(field.key); });
    return keys;
}

/// The paper gives its colors as bytes; they are linear values divided by 255 (docs/rig_format.md).
void read_color_bytes(const ObjectReader& reader, glm::dvec3& color) {
    if (reader.find("color_bytes") == nullptr) return;
    if (reader.find("color") != nullptr)
        reader.refuse("color_bytes", "stands beside color", "give one of the two");
    reader.read("color_bytes", color, {0.0, 255.0});
    color /= 255.0;
}

Light read_light(const LocatedJson& file, const json& value, const std::string& name) {
    const ObjectReader reader(file, value, name);
    constexpr const char* kinds = "give POINT, SUN, SPOT or AREA";
    if (reader.find("kind") == nullptr) reader.refuse("kind", "is missing", kinds);
    LightSettings light;
    light.shape = default_shape(reader.named("kind", light_kind, kinds));
    reader.allow_only(keys_of(light));
    for_each_field(light, [&](const auto& field, auto& owner) {
        reader.read(field.key, owner.*field.member, limits(field.range));
    });
    read_color_bytes(reader, light.color);
    if (!std::holds_alternative<PointLight>(light.shape) && light.direction == glm::dvec3(0.0))
        reader.refuse("direction", "has length 0", "give where the light shines to");
    return light;
}

void check_version(const ObjectReader& reader) {
    const json* version = reader.find("skinglow_rig");
    if (version == nullptr)
        reader.refuse("skinglow_rig", "is missing", "a light rig begins with \"skinglow_rig\": 1");
    if (*version != rig_version) {
        reader.refuse("skinglow_rig", "is " + shown(*version), "this version of skinglow reads format 1");
    }
}

}  // namespace

void validate(const LightRig& rig) {
    require_finite("point", rig.point);
    require_not_negative("blood_weight", rig.blood_weight);
    validate(rig.coefficients);
}

LightRig read_light_rig(const std::filesystem::path& path) {
    const LocatedJson file(path);
    const ObjectReader reader(file, file.value(), "");
    check_version(reader);
    reader.allow_only(
        {"skinglow_rig", "name", "description", "point", "attenuation", "blood_weight", "lights"});
    LightRig rig;
    std::string description;  // for people; checked, not kept
    const Limits any = limits(FieldRange::any);
    const Limits not_negative = limits(FieldRange::not_negative);
    reader.read("name", rig.name);
    reader.read("description", description);
    reader.read("point", rig.point, any);
    reader.read("blood_weight", rig.blood_weight, not_negative);
    if (const json* value = reader.find("attenuation")) {
        const ObjectReader attenuation(file, *value, "attenuation");
        attenuation.allow_only({"constant", "linear", "quadratic"});
        attenuation.read("constant", rig.coefficients.constant, not_negative);
        attenuation.read("linear", rig.coefficients.linear, not_negative);
        attenuation.read("quadratic", rig.coefficients.quadratic, not_negative);
    }
    const json* lights = reader.find("lights");
    if (lights == nullptr) reader.refuse("lights", "is missing", "give a list of lights; [] for none");
    if (!lights->is_array()) reader.refuse("lights", "is " + shown(*lights), "give a list [...]");
    for (std::size_t i = 0; i < lights->size(); ++i) {
        rig.lights.push_back(read_light(file, (*lights)[i], "lights[" + std::to_string(i) + "]"));
    }
    return rig;
}

}  // namespace skinglow::detail
