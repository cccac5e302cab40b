#include "cli/mesh_options.h"

#include <unistd.h>

#include <iostream>

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
    command.add_option(mesh_name, path_, "OBJ, PLY, GLB or another format that Assimp reads")->required();
    command.add_option("--unit", thickness_.unit_mm, "Length of the mesh's unit; 1000 for meters")
        ->type_name("MM")
        ->capture_default_str();
    command.add_option("--group", group_, "Only this group or object of the file")->type_name("NAME");
    command.add_option("--rays", thickness_.rays, "Rays per vertex")->type_name("N")->capture_default_str();
    command
        .add_option("--min-sky-visibility,--min-openness", thickness_.min_sky_visibility,
                    "Fraction of the sky's light below which a hollow counts as flesh, 0 to 1")
        ->type_name("X")
        ->capture_default_str();
}

std::vector<double> MeshOptions::measure(const TriangleMesh& mesh) const {
    return thickness(mesh, thickness_, show_progress);
}

}  // namespace skinglow::cli
