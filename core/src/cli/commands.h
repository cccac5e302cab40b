#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// The sub-commands of `skinglow`, a file each or for two that belong together. Adding one to the program: it says its options, and what it
/// does when it is the one chosen. What it does reports errors by throwing; `exit_code` is for outcomes that
/// are no error.
namespace skinglow::cli {

/// Adds an option that takes a value.
/// @param type  what --help calls the value
template <typename Value>
CLI::Option& add_option(CLI::App& command, const char* name, Value& value, const char* type,
                        const std::string& description) {
    return *command.add_option(name, value, description)->type_name(type);
}

void add_weights_command(CLI::App& program);
void add_lut_command(CLI::App& program);
void add_rig_command(CLI::App& program);
void add_compare_command(CLI::App& program, int& exit_code);
#ifdef SKINGLOW_HAS_RAYS
void add_thickness_command(CLI::App& program);
void add_povray_command(CLI::App& program);
#endif

}  // namespace skinglow::cli
