#include <algorithm>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "rig_files/light_fields.h"
#include "rig_files/light_rig.h"
#include "rig_files/located_json.h"

namespace skinglow {
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

    void read(std::string_view key, double& into, double least, double most) const {
        if (const json* value = find(key)) into = number(*value, key_name(key), least, most);
    }

    void read(std::string_view key, glm::dvec3& into, double least, double most) const {
        const json* value = find(key);
        if (value == nullptr) return;
        if (!value->is_array() || value->size() != 3)
            refuse(key, "is " + shown(*value), "give a list of three numbers");
        for (int i = 0; i < 3; ++i) {
            const auto place = static_cast<std::size_t>(i);
            into[i] = number((*value)[place], key_name(key) + "[" + std::to_string(i) + "]", least, most);
        }
    }

    void read(std::string_view key, bool& into) const {
        const json* value = find(key);
        if (value == nullptr) return;
        if (!value->is_boolean()) refuse(key, "is " + shown(*value), "give true or false");
        into = value->get<bool>();
    }

    void read(std::string_view key, std::string& into) const {
        const json* value = find(key);
        if (value == nullptr) return;
        if (!value->is_string()) refuse(key, "is " + shown(*value), "give a text in quotes");
        into = value->get<std::string>();
    }

  private:
    double number(const json& value, const std::string& name, double least, double most) const {
        std::string allowed = "give a number";
        if (least == 0.0) allowed += most == any_size ? ", 0 or more" : " of 0 to " + to_text(most);
        if (!value.is_number()) file_.refuse(name, "is " + shown(value), allowed);
        const double found = value.get<double>();
        if (found < least || found > most) file_.refuse(name, "is " + shown(value), allowed);
        return found;
    }

    const LocatedJson& file_;
    const json& object_;
    std::string name_;
};

LightKind read_kind(const ObjectReader& reader) {
    if (reader.find("kind") == nullptr) reader.refuse("kind", "is missing", "give POINT, SUN, SPOT or AREA");
    std::string text;
    reader.read("kind", text);
    try {
        return light_kind(text);
    } catch (const std::invalid_argument&) {
        reader.refuse("kind", "is \"" + text + "\"", "give POINT, SUN, SPOT or AREA");
    }
}

std::vector<std::string_view> keys_of(LightKind kind) {
    std::vector<std::string_view> keys = {"kind", "name", "color_bytes"};
    const auto add = [&](const auto& fields) {
        for (const auto& field : fields) {
            if (field.kinds.include(kind)) keys.push_back(field.key);
        }
    };
    add(vector_fields);
    add(number_fields);
    add(switch_fields);
    if (kind == LightKind::area) keys.emplace_back("area_shape");
    return keys;
}

/// The paper gives its colors as bytes; they are linear values divided by 255 (docs/rig_format.md).
void read_color_bytes(const ObjectReader& reader, Light& light) {
    if (reader.find("color_bytes") == nullptr) return;
    if (reader.find("color") != nullptr)
        reader.refuse("color_bytes", "stands beside color", "give one of the two");
    reader.read("color_bytes", light.color, 0.0, 255.0);
    light.color /= 255.0;
}

void read_area_shape(const ObjectReader& reader, Light& light) {
    if (reader.find("area_shape") == nullptr) return;
    std::string text;
    reader.read("area_shape", text);
    try {
        light.area_shape = area_shape(text);
    } catch (const std::invalid_argument&) {
        reader.refuse("area_shape", "is \"" + text + "\"", "give RECTANGLE, SQUARE, ELLIPSE or DISK");
    }
}

Light read_light(const LocatedJson& file, const json& value, const std::string& name) {
    const ObjectReader reader(file, value, name);
    Light light;
    light.kind = read_kind(reader);
    reader.allow_only(keys_of(light.kind));
    reader.read("name", light.name);
    for (const VectorField& field : vector_fields) {
        reader.read(field.key, light.*field.member, field.may_be_negative ? -any_size : 0.0, any_size);
    }
    for (const NumberField& field : number_fields)
        reader.read(field.key, light.*field.member, field.min, field.max);
    for (const SwitchField& field : switch_fields) reader.read(field.key, light.*field.member);
    read_color_bytes(reader, light);
    read_area_shape(reader, light);
    if (light.kind != LightKind::point && light.direction == glm::dvec3(0.0)) {
        reader.refuse("direction", "has length 0", "give where the lamp shines to");
    }
    try {
        validate(light);  // the core has the last word on what a lamp is
    } catch (const std::invalid_argument& error) {
        file.refuse(name, error.what(), "correct it");
    }
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

LightRig read_light_rig(const std::filesystem::path& path) {
    const LocatedJson file(path);
    const ObjectReader reader(file, file.value(), "");
    check_version(reader);
    reader.allow_only(
        {"skinglow_rig", "name", "description", "point", "attenuation", "blood_weight", "lights"});
    LightRig rig;
    std::string description;  // for people; checked, not kept
    reader.read("name", rig.name);
    reader.read("description", description);
    reader.read("point", rig.point, -any_size, any_size);
    reader.read("blood_weight", rig.blood_weight, 0.0, any_size);
    if (const json* value = reader.find("attenuation")) {
        const ObjectReader attenuation(file, *value, "attenuation");
        attenuation.allow_only({"constant", "linear", "quadratic"});
        attenuation.read("constant", rig.coefficients.constant, 0.0, any_size);
        attenuation.read("linear", rig.coefficients.linear, 0.0, any_size);
        attenuation.read("quadratic", rig.coefficients.quadratic, 0.0, any_size);
    }
    const json* lights = reader.find("lights");
    if (lights == nullptr) reader.refuse("lights", "is missing", "give a list of lights; [] for none");
    if (!lights->is_array()) reader.refuse("lights", "is " + shown(*lights), "give a list [...]");
    for (std::size_t i = 0; i < lights->size(); ++i) {
        rig.lights.push_back(read_light(file, (*lights)[i], "lights[" + std::to_string(i) + "]"));
    }
    return rig;
}

}  // namespace skinglow
