#include <array>
#include <cmath>
#include <string>

#include "files/atomic_file.h"
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

constexpr std::string_view column_names = "thickness_mm,r,g,b";
// A row has at most 4 numbers of 24 characters: twice the longest table, with room for the header.
constexpr std::size_t max_csv_bytes = max_lut_size * 200;

std::array<double, 4> parse_row(std::string_view row, const std::filesystem::path& path,
                                const std::string& where) {
    std::array<double, 4> numbers{};
    std::string_view rest = row;
    for (double& number : numbers) {
        const auto parsed = parse_number(take_until(rest, ','));
        if (!parsed)
            refuse_file(path, "is \"" + std::string(row) + "\"", "give four finite numbers with commas",
                        where);
        number = *parsed;
    }
    if (!rest.empty()) refuse_file(path, "has more than four columns", "give thickness_mm,r,g,b", where);
    return numbers;
}

/// "# skinglow:key: value" into the header text; other comments are for people. Spreadsheets give each row as many
/// commas as the widest has.
void take_comment(std::string_view line, HeaderText& text) {
    while (line.ends_with(',')) line.remove_suffix(1);
    line.remove_prefix(1);
    if (line.starts_with(' ')) line.remove_prefix(1);
    const std::size_t end = line.find(": ");
    if (line.starts_with("skinglow:") && end != std::string_view::npos) {
        text[std::string(line.substr(0, end))] = std::string(line.substr(end + 2));
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

void write_lut_csv(const std::filesystem::path& path, const LutTable& table) {
    const LutAxis axis(table.colors.size(), table.record.max_thickness_mm);
    std::string text = "# Light coming through skin, linear Rec.709, by thickness in mm.\n";
    for (const auto& [key, value] : to_header_text(table.record)) {
        text.append("# ").append(key).append(": ").append(value).append("\n");
    }
    text += column_names;
    text += '\n';
    for (std::size_t i = 0; i < table.colors.size(); ++i) {
        const glm::dvec3& color = table.colors[i];
        text += to_text(axis.thickness_mm(i)) + "," + to_text(color.r) + "," + to_text(color.g) + "," +
                to_text(color.b) + "\n";
    }
    write_atomically(path, text);
}

LutFile read_lut_csv(const std::filesystem::path& path) {
    const std::string content = read_whole_file(path, max_csv_bytes);
    std::string_view rest = content;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // a spreadsheet's
    HeaderText text;
    std::vector<glm::dvec3> colors;
    std::vector<double> thickness;
    std::vector<std::size_t> lines;
    bool header_seen = false;
    for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
        std::string_view line = take_until(rest, '\n');
        if (line.ends_with('\r')) line.remove_suffix(1);
        const std::string where = "line " + std::to_string(line_number);
        if (line.find_first_not_of(',') == std::string_view::npos) continue;  // an empty row
        if (line.starts_with('#')) {
            take_comment(line, text);
        } else if (!header_seen) {
            if (line != column_names)
                refuse_file(path, "does not name the columns thickness_mm,r,g,b", "write it with skinglow",
                            where);
            header_seen = true;
        } else {
            const auto [mm, red, green, blue] = parse_row(line, path, where);
            thickness.push_back(mm);
            lines.push_back(line_number);
            colors.emplace_back(red, green, blue);
        }
    }
    if (colors.empty() || !content.ends_with('\n'))
        refuse_file(path, "ends too early", "it was not written to its end; make it anew");
    const LutRecord record = to_lut_record(text, path);
    if (colors.size() > max_lut_size) {
        refuse_file(path, "has " + std::to_string(colors.size()) + " entries",
                    "at most " + std::to_string(max_lut_size));
    }
    const LutAxis axis(colors.size(), record.max_thickness_mm);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const double expected = axis.thickness_mm(i);
        // Rounding in a spreadsheet is forgiven, a missing or moved row is not.
        if (std::abs(thickness[i] - expected) > 1e-6 * record.max_thickness_mm) {
            refuse_file(
                path, "has thickness " + to_text(thickness[i]) + " mm where " + to_text(expected) + " is due",
                "rows are evenly spaced from 0 to max_thickness_mm; none may be missing",
                "line " + std::to_string(lines[i]));
        }
    }
    return {{std::move(colors), record}, {}};
}

}  // namespace skinglow::detail
