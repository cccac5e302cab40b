#pragma once

#include <skinglow/lut.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace skinglow::cli {

/// The options by which commands choose the skin of mode `physical`.
class SkinOptions {
  public:
    /// Adds --skin, one option for each parameter of a Tissue, and --tolerance.
    void add_to(CLI::App& command);

    /// True where one of the options was used.
    bool any_used() const;
    /// The preset with the parameters that were given put in place. Throws std::invalid_argument.
    Tissue tissue() const;
    double tolerance() const { return tolerance_; }

  private:
    std::string preset_ = "light";
    std::map<std::string_view, double> values_;
    std::map<std::string_view, CLI::Option*> options_;
    double tolerance_ = default_lut_tolerance;
    CLI::Option* preset_option_ = nullptr;
    CLI::Option* tolerance_option_ = nullptr;
};

}  // namespace skinglow::cli
