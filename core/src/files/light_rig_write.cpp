#include <nlohmann/json.hpp>

#include "files/atomic_file.h"
#include "numerics/argument_check.h"
#include "rig_files/light_fields.h"
#include "rig_files/light_rig.h"

namespace skinglow {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const glm::dvec3& value) {
    return ordered_json::array({value.x, value.y, value.z});
}

/// What the kind has and what is not the default: a file holds what its lamp needs.
ordered_json to_json(const Light& light) {
    const Light usual;
    ordered_json object;
    object["kind"] = to_text(light.kind);
    if (!light.name.empty()) object["name"] = light.name;
    for (const VectorField& field : vector_fields) {
        const bool needed = field.key == "color" || light.*field.member != usual.*field.member;
        if (field.kinds.include(light.kind) && needed)
            object[std::string(field.key)] = numbers(light.*field.member);
    }
    for (const NumberField& field : number_fields) {
        const bool needed = field.key == "power" || light.*field.member != usual.*field.member;
        if (field.kinds.include(light.kind) && needed) object[std::string(field.key)] = light.*field.member;
    }
    for (const SwitchField& field : switch_fields) {
        const bool needed = light.*field.member != usual.*field.member;
        if (field.kinds.include(light.kind) && needed) object[std::string(field.key)] = light.*field.member;
    }
    if (light.kind == LightKind::area && light.area_shape != usual.area_shape) {
        object["area_shape"] = to_text(light.area_shape);
    }
    return object;
}

}  // namespace

void validate(const LightRig& rig) {
    require_finite("point", rig.point);
    require_not_negative("blood_weight", rig.blood_weight);
    validate(rig.coefficients);
    for (const Light& light : rig.lights) validate(light);
}

void write_light_rig(const std::filesystem::path& path, const LightRig& rig) {
    validate(rig);
    ordered_json object;
    object["skinglow_rig"] = 1;
    if (!rig.name.empty()) object["name"] = rig.name;
    object["point"] = numbers(rig.point);
    object["attenuation"] = {{"constant", rig.coefficients.constant},
                             {"linear", rig.coefficients.linear},
                             {"quadratic", rig.coefficients.quadratic}};
    object["blood_weight"] = numbers(rig.blood_weight);
    object["lights"] = ordered_json::array();
    for (const Light& light : rig.lights) object["lights"].push_back(to_json(light));
    // A name from a host may hold bytes that are no UTF-8; a rig with a replaced letter beats none.
    const std::string text = object.dump(2, ' ', false, ordered_json::error_handler_t::replace);
    write_text_atomically(path, text + "\n");
}

}  // namespace skinglow
