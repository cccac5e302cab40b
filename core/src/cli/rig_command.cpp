#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/rig_options.h"
#include "files/atomic_file.h"

namespace skinglow::cli {
namespace {

struct Options {
    RigOptions rig;
    std::string output;
};

}  // namespace

void add_rig_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "rig", "Write lights as a rig file: a studio light of Blender's, or a rig with numbers changed");
    auto options = std::make_shared<Options>();
    options->rig.add_to(*command, RigNeed::required);
    command->add_option("-o,--output", options->output, "Rig file to write (JSON, docs/rig_format.md)")
        ->required();
    command->footer("Example: skinglow rig rim.sl --camera-rotation 90 0 35 -o rim.json");
    command->callback([options] {
        refuse_overwriting({options->output}, {options->rig.path()});
        const LightRig rig = options->rig.read();
        write_light_rig(options->output, rig);
        std::cout << options->output << ": " << rig.lights.size() << " lights\n";
    });
}

}  // namespace skinglow::cli
