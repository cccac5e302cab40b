#pragma once

#include <skinglow/lut.h>

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
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
    double tolerance() const { return tolerance_.value_or(default_lut_tolerance); }

  private:
    std::optional<std::string> preset_;
    std::map<std::string_view, std::optional<double>> values_;
    std::optional<double> tolerance_;
};

}  // namespace skinglow::cli
