#include <algorithm>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/mesh_options.h"
#include "cli/output_text.h"
#include "files/atomic_file.h"

namespace skinglow::cli {
namespace {

struct ThicknessArguments {
    MeshOptions mesh;
    std::string output;
};

void run_thickness(ThicknessArguments& options) {
    require_writable(options.output, "thickness", {".csv", ".ply"});
    const TriangleMesh mesh = options.mesh.read();
    refuse_overwriting({options.output}, options.mesh.sources());
    std::vector<double> values = options.mesh.measure(mesh);
    write_thickness(options.output, mesh, values, options.mesh.unit_mm());
    std::sort(values.begin(), values.end());
    std::cout << options.output << ": " << mesh.vertices().size() << " vertices, " << mesh.triangles().size()
              << " triangles, thickness " << short_number(values.front()) << " to "
              << short_number(values.back()) << " mm, median " << short_number(values[values.size() / 2])
              << " mm\n";
}

}  // namespace

void add_thickness_command(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("thickness", "How thick a body is at each vertex of its mesh, in mm");
    const auto options = std::make_shared<ThicknessArguments>();
    options->mesh.add_to(*command, "MESH");
    add_option(*command, "-o,--output", options->output, "FILE", "File to write: .csv or .ply").required();
    command->footer("Example: skinglow thickness head.obj --unit 100 --group body -o thickness.csv");
    command->callback([options] { run_thickness(*options); });
}

}  // namespace skinglow::cli
