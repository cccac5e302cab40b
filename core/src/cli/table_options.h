#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/rig_options.h"
#include "files/lut_file.h"

namespace skinglow::cli {

/// The options by which commands choose the mode and the base lookup.
class TableOptions {
  public:
    /// Adds --mode, --base, --size and --max-thickness. @param with_skin  mode physical is one to choose
    void add_to(CLI::App& command, bool with_skin = false);

    LutMode mode() const { return lut_mode(mode_); }
    bool has_mode() const { return mode_option_->count() > 0; }
    bool has_base() const { return !base_.empty(); }
    /// True where one of the options was used.
    bool any_used() const;
    /// Of the built-in base. Throws std::invalid_argument.
    LutAxis built_in_axis() const { return {size_, max_thickness_mm_}; }
    /// The image that was given, with notes on standard error, else the built-in skin profile.
    /// Throws FileError and std::invalid_argument.
    BaseLut read_base() const;

    /// The file of --base; empty without.
    const std::string& base_path() const { return base_; }

  private:
    std::string mode_{to_text(LutMode::paper)};
    std::string base_;
    std::size_t size_ = default_lut_size;
    double max_thickness_mm_ = default_max_thickness_mm;
    CLI::Option* mode_option_ = nullptr;
    CLI::Option* size_option_ = nullptr;
    CLI::Option* max_thickness_option_ = nullptr;
};

}  // namespace skinglow::cli
