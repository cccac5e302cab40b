#include "cli/table_options.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <utility>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {
namespace {

constexpr const char* default_preset = "light";

/// What the parameters of a Tissue are called on the command line.
constexpr std::array<std::pair<std::string_view, const char*>, 7> option_names = {{
    {"melanin_fraction", "--melanin"},
    {"blood_fraction", "--blood-fraction"},
    {"oxygen_saturation", "--oxygen"},
    {"epidermal_thickness_mm", "--epidermis"},
    {"scattering_scale", "--scattering"},
    {"refractive_index", "--index"},
    {"cartilage_fraction", "--cartilage"},
}};

std::string describe(const TissueParameter& parameter) {
    std::string text(parameter.description);
    text.append("; ").append(to_text(parameter.minimum)).append(" to ").append(to_text(parameter.maximum));
    return text.append("; else the preset's");
}

}  // namespace

LutMode TableOptions::mode(const SkinOptions& skin) const {
    const LutMode chosen = mode_ ? lut_mode(*mode_) : LutMode::paper;
    if (!skin.any_used()) return chosen;
    if (mode_ && chosen != LutMode::physical)
        throw std::invalid_argument("--skin and its options belong to --mode physical");
    return LutMode::physical;
}

SkinLut TableOptions::solve_skin(const SkinOptions& skin) const {
    if (has_base())
        throw std::invalid_argument("--mode physical makes its base from the skin: leave out --base");
    const LutAxis axis = built_in_axis();
    return base_lut_report(skin.tissue(), axis.size(), axis.max_thickness_mm(), skin.tolerance());
}

void TableOptions::add_to(CLI::App& command) {
    const std::set<std::string> names{"existing", "paper", "physical"};
    command
        .add_option("--mode", mode_,
                    "paper: base * (B + L); existing: a fixed reddish table that knows no lights; physical: "
                    "the skin of --skin times the lights' irradiance")
        ->check(CLI::IsMember(names))
        ->default_str("paper");
    add_option(command, "--base", base_, "IMAGE",
               "Base lookup image, thickness along x; else the built-in six-Gaussian skin");
    add_option(command, "--size", size_, "N", "Texels of the built-in base")
        .default_str(to_text(default_lut_size));
    add_option(command, "--max-thickness", max_thickness_mm_, "MM", "Thickness of the last texel")
        .default_str(to_text(default_max_thickness_mm));
}

BaseLut TableOptions::read_base() const {
    if (!has_base()) return six_gaussian_base(built_in_axis());
    if (size_) {
        throw std::invalid_argument(
            "--size is for the built-in base; a table from --base has the size of its image");
    }
    BaseLutFile file = read_base_lut(base_, max_thickness_mm_);
    for (const std::string& note : file.notes) tell(base_, note);
    return file.base;
}

void SkinOptions::add_to(CLI::App& command) {
    std::string presets;
    for (const TissuePreset& preset : tissue_presets()) {
        presets.append(presets.empty() ? "" : ", ").append(preset.name);
    }
    add_option(command, "--skin", preset_, "PRESET", "Of mode physical: " + presets)
        .default_str(default_preset);
    for (const TissueParameter& parameter : tissue_parameters()) {
        const auto* named = std::find_if(option_names.begin(), option_names.end(),
                                         [&](const auto& entry) { return entry.first == parameter.name; });
        add_option(command, named->second, values_[parameter.name], parameter.unit == "mm" ? "MM" : "X",
                   describe(parameter));
    }
    add_option(command, "--tolerance", tolerance_, "X",
               "Largest error of mode physical, relative; 1e-6 to 0.1")
        .default_str(to_text(default_lut_tolerance));
}

bool SkinOptions::any_used() const {
    return preset_ || tolerance_ || std::any_of(values_.begin(), values_.end(), [](const auto& entry) {
               return entry.second.has_value();
           });
}

Tissue SkinOptions::tissue() const {
    Tissue tissue = tissue_preset(preset_.value_or(default_preset)).tissue;
    for (const TissueParameter& parameter : tissue_parameters()) {
        if (const auto& value = values_.at(parameter.name)) tissue.*parameter.field = *value;
    }
    validate(tissue);
    return tissue;
}

}  // namespace skinglow::cli
