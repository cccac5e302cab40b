#include <nlohmann/json.hpp>

#include "files/atomic_file.h"
#include "light/light_fields.h"
#include "numerics/argument_check.h"
#include "rig_files/light_rig.h"

namespace skinglow::detail {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const glm::dvec3& value) {
    return ordered_json::array({value.x, value.y, value.z});
}
ordered_json json_of(AreaShape value) {
    return to_text(value);
}
template <typename Value>
ordered_json json_of(const Value& value) {
    return value;
}

/// What the kind has and what is not the default: a file holds what its light needs.
ordered_json json_of_light(const Light& light) {
    ordered_json object;
    object["kind"] = to_text(light.kind());
    for_each_field(light.settings(), [&](const auto& field, const auto& owner) {
        static const std::remove_cvref_t<decltype(owner)> usual;
        const bool is_needed = field.key == "color" || field.key == "power";
        if (is_needed || owner.*field.member != usual.*field.member)
            object[std::string(field.key)] = json_of(owner.*field.member);
    });
    return object;
}

}  // namespace

void write_light_rig(const std::filesystem::path& path, const LightRig& rig) {
    validate(rig);
    ordered_json object;
    object["skinglow_rig"] = 1;
    if (!rig.name.empty()) object["name"] = rig.name;
    object["point"] = json_of(rig.point);
    object["attenuation"] = {{"constant", rig.coefficients.constant},
                             {"linear", rig.coefficients.linear},
                             {"quadratic", rig.coefficients.quadratic}};
    object["blood_weight"] = json_of(rig.blood_weight);
    object["lights"] = ordered_json::array();
    for (const Light& light : rig.lights) object["lights"].push_back(json_of_light(light));
    // A name from a host may hold bytes that are no UTF-8; a rig with a replaced letter beats none.
    const std::string text = object.dump(2, ' ', false, ordered_json::error_handler_t::replace);
    write_atomically(path, text + "\n");
}

}  // namespace skinglow::detail
