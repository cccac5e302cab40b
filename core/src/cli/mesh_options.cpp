#include "cli/mesh_options.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "cli/commands.h"
#include "cli/output_text.h"

namespace skinglow::cli {
namespace {

bool show_progress(double done) {
    if (::isatty(STDERR_FILENO) != 0) {
        std::cerr << "\rthickness: " << static_cast<int>(done * 100.0) << "%" << (done < 1.0 ? "" : "\n")
                  << std::flush;
    }
    return true;
}

}  // namespace

void MeshOptions::add_to(CLI::App& command, const std::string& mesh_name) {
    command.add_option(mesh_name, path_, "OBJ, PLY, STL, glTF or GLB")->required();
    add_option(command, "--unit", unit_mm_, "MM",
               "Length of the mesh's unit; else 1000 for glTF and GLB, whose unit is the meter, and 1");
    add_option(command, "--group", group_, "NAME", "Only this group or object of the file");
    add_option(command, "--rays", thickness_.rays, "N", "Rays per vertex");
    add_option(command, "--min-sky-visibility,--min-openness", thickness_.min_sky_visibility, "X",
               "Fraction of the sky's light below which a hollow counts as flesh, 0 to 1");
}

TriangleMesh MeshOptions::read() {
    MeshFile file = read_mesh(path_, group_);
    for (const std::string& note : file.notes) tell(path_, note);
    thickness_.unit_mm = unit_mm_.value_or(file.unit_mm);
    has_y_up_ = file.has_y_up;
    sources_ = std::move(file.sources);
    return joined(std::move(file.mesh));
}

std::vector<double> MeshOptions::measure(const TriangleMesh& mesh) const {
    ThicknessReport report = thickness_report(mesh, thickness_, show_progress);
    const auto none = std::count(report.no_far_side.begin(), report.no_far_side.end(), 1);
    if (none > 0) {
        tell(
            path_,
            std::to_string(none) + " of " + std::to_string(report.mm.size()) + " vertices (" +
                short_number(100.0 * report.no_far_side_fraction()) +
                " %) found no far side: the mesh is open, doubled or flat there; they are given the diagonal "
                "of its box, " +
                short_number(*std::max_element(report.mm.begin(), report.mm.end())) + " mm");
    }
    return std::move(report.mm);
}

}  // namespace skinglow::cli
