#include "cli/table_options.h"

#include <set>
#include <stdexcept>

#include "cli/output_text.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {

void TableOptions::add_to(CLI::App& command, bool with_skin) {
    std::string modes = "paper: base * (B + L); existing: a fixed reddish table that knows no lights";
    std::set<std::string> names{"existing", "paper"};
    if (with_skin) {
        modes += "; physical: the skin of --skin times the lights' irradiance";
        names.insert("physical");
    }
    command.add_option("--mode", mode_, modes)->check(CLI::IsMember(names))->default_str("paper");
    command
        .add_option("--base", base_,
                    "Base lookup image, thickness along x; else the built-in six-Gaussian skin")
        ->type_name("IMAGE");
    command.add_option("--size", size_, "Texels of the built-in base")
        ->type_name("N")
        ->default_str(std::to_string(default_lut_size));
    command.add_option("--max-thickness", max_thickness_mm_, "Thickness of the last texel")
        ->type_name("MM")
        ->default_str(to_text(default_max_thickness_mm));
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

}  // namespace skinglow::cli
