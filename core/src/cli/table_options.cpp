#include "cli/table_options.h"

#include <skinglow/lut.h>

#include <optional>
#include <set>
#include <stdexcept>

#include "cli/output_text.h"

namespace skinglow::cli {

void TableOptions::add_to(CLI::App& command, bool with_skin) {
    std::string modes = "paper: base * (B + L); existing: a fixed reddish table that knows no lights";
    std::set<std::string> names{"existing", "paper"};
    if (with_skin) {
        modes += "; physical: the skin of --skin times the lights' irradiance";
        names.insert("physical");
    }
    mode_option_ =
        command.add_option("--mode", mode_, modes)->check(CLI::IsMember(names))->capture_default_str();
    command
        .add_option("--base", base_,
                    "Base lookup image, thickness along x; else the built-in six-Gaussian skin")
        ->type_name("IMAGE");
    size_option_ = command.add_option("--size", size_, "Texels of the built-in base")
                       ->type_name("N")
                       ->capture_default_str();
    max_thickness_option_ =
        command.add_option("--max-thickness", max_thickness_mm_, "Thickness of the last texel")
            ->type_name("MM")
            ->capture_default_str();
}

bool TableOptions::any_used() const {
    return has_base() || mode_option_->count() + size_option_->count() + max_thickness_option_->count() > 0;
}

BaseLut TableOptions::read_base() const {
    if (!has_base()) return six_gaussian_base(built_in_axis());
    if (size_option_->count() > 0) {
        throw std::invalid_argument(
            "--size is for the built-in base; a table from --base has the size of its image");
    }
    std::optional<double> axis;
    if (max_thickness_option_->count() > 0) axis = max_thickness_mm_;
    BaseLutFile file = read_base_lut(base_, axis);
    for (const std::string& note : file.notes) tell(base_, note);
    return file.base;
}

}  // namespace skinglow::cli
