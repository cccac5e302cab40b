#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "cli/commands.h"

namespace {

constexpr int failed = 2;  // 1 means: worked, and the answer is no (compare --max-rms)

int fail(const std::string& message) {
    std::cerr << "skinglow: " << message << '\n';
    return failed;
}

/// The command line's own errors name the option; where to read on is what they lack.
std::string with_help(const CLI::App& program, const std::string& message) {
    std::string command = "skinglow";
    for (const CLI::App* chosen : program.get_subcommands()) command += " " + chosen->get_name();
    return "command line: " + message + ": see " + command + " --help";
}

int run(int argc, char** argv) {
    CLI::App program(
        "Skin that glows in the color of your lights: lookup tables for light coming through skin.");
    program.name("skinglow");
    program.set_version_flag("--version", SKINGLOW_VERSION);
    program.require_subcommand(1);
    program.option_defaults()
        ->always_capture_default();  // shown by --help; also of the sub-commands added below
    program.footer("skinglow COMMAND --help tells more. Lengths are in mm, colors linear Rec.709.");
    int exit_code = 0;
    skinglow::cli::add_weights_command(program);
    skinglow::cli::add_lut_command(program);
    skinglow::cli::add_rig_command(program);
#ifdef SKINGLOW_HAS_RAYS
    skinglow::cli::add_thickness_command(program);
    skinglow::cli::add_povray_command(program);
#endif
    skinglow::cli::add_compare_command(program, exit_code);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);  // --help and --version
        return fail(with_help(program, error.what()));
    }
    std::cout.flush();
    if (!std::cout) return fail("standard output: cannot be written: is the disk full or the reader gone?");
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        return fail("not enough memory: use smaller files");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
