#pragma once

#include <skinglow/tissue.h>

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>

#include "cli/rig_options.h"
#include "files/lut_file.h"

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

/// The options by which commands choose the mode and the base lookup.
class TableOptions {
  public:
    /// Adds --mode, --base, --size and --max-thickness.
    void add_to(CLI::App& command);

    /// What --mode says, else paper; the options of skin alone say physical.
    /// Throws std::invalid_argument where those are given with another mode.
    LutMode mode(const SkinOptions& skin) const;
    bool has_base() const { return !base_.empty(); }
    /// True where one of the options was used.
    bool any_used() const { return has_base() || mode_ || size_ || max_thickness_mm_; }
    /// Of the built-in base. Throws std::invalid_argument.
    LutAxis built_in_axis() const {
        return {size_.value_or(default_lut_size), max_thickness_mm_.value_or(default_max_thickness_mm)};
    }
    /// The image that was given, with notes on standard error, else the built-in skin profile.
    /// Throws FileError and std::invalid_argument.
    BaseLut read_base() const;
    /// Of mode physical. Throws std::invalid_argument, also with --base.
    SkinLut solve_skin(const SkinOptions& skin) const;

    /// The file of --base; empty if not given.
    const std::string& base_path() const { return base_; }

  private:
    std::optional<std::string> mode_;
    std::string base_;
    std::optional<std::size_t> size_;
    std::optional<double> max_thickness_mm_;
};

}  // namespace skinglow::cli
