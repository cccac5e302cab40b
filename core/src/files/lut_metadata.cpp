
#include "files/lut_file.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {
namespace {

constexpr const char* axis_key = "skinglow:max_thickness_mm";
constexpr const char* foreign_remedy = "give a table that skinglow wrote, unchanged";

/// Three numbers, each in the shortest text that gives the same double back.
std::string three_numbers(const glm::dvec3& value) {
    return to_text(value.x) + " " + to_text(value.y) + " " + to_text(value.z);
}

std::optional<glm::dvec3> find_three_numbers(const HeaderText& text, const std::string& key,
                                             const std::filesystem::path& path) {
    const auto found = text.find(key);
    if (found == text.end()) return std::nullopt;
    glm::dvec3 value{0.0};
    std::string_view rest = found->second;
    for (int i = 0; i < 3; ++i) {
        const auto number = parse_number(i < 2 ? take_until(rest, ' ') : rest);
        if (!number)
            refuse_file(path, "is \"" + found->second + "\", not three numbers", foreign_remedy,
                        "key " + key);
        value[i] = *number;
    }
    return value;
}

std::optional<LutMode> mode_in(const HeaderText& text, const std::filesystem::path& path) {
    const auto found = text.find("skinglow:mode");
    if (found == text.end()) return std::nullopt;
    try {
        return lut_mode(found->second);
    } catch (const std::invalid_argument& refusal) {
        refuse_file(path, refusal.what(), foreign_remedy, "key skinglow:mode");
    }
}

}  // namespace

HeaderText to_header_text(const LutRecord& record) {
    HeaderText text{{"skinglow:table", "recolored"}, {axis_key, to_text(record.max_thickness_mm)}};
    if (record.mode) text["skinglow:mode"] = to_text(*record.mode);
    if (record.light_weight) text["skinglow:light_weight"] = three_numbers(*record.light_weight);
    if (record.blood_weight) text["skinglow:blood_weight"] = three_numbers(*record.blood_weight);
    if (const auto& k = record.coefficients) {
        text["skinglow:coefficients"] = three_numbers({k->constant, k->linear, k->quadratic});
    }
    return text;
}

std::optional<double> axis_in(const HeaderText& text, const std::filesystem::path& path) {
    const auto found = text.find(axis_key);
    if (found == text.end()) return std::nullopt;
    const auto value = parse_number(found->second);
    if (!value || *value <= 0.0) {
        refuse_file(path, "is \"" + found->second + "\", not a number above 0", foreign_remedy,
                    std::string("key ") + axis_key);
    }
    return value;
}

LutRecord to_lut_record(const HeaderText& text, const std::filesystem::path& path) {
    const auto axis = axis_in(text, path);
    if (!axis) {
        refuse_file(path,
                    std::string("has no key ") + axis_key + " in its header, so it is no recolored table",
                    "an ordinary image is read as a base lookup instead");
    }
    LutRecord record;
    record.max_thickness_mm = *axis;
    record.mode = mode_in(text, path);
    record.light_weight = find_three_numbers(text, "skinglow:light_weight", path);
    record.blood_weight = find_three_numbers(text, "skinglow:blood_weight", path);
    if (const auto k = find_three_numbers(text, "skinglow:coefficients", path)) {
        record.coefficients = AttenuationCoefficients{k->x, k->y, k->z};
    }
    return record;
}

}  // namespace skinglow::detail
