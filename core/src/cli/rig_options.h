#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

#include "files/lut_file.h"
#include "rig_files/light_rig.h"

namespace skinglow::cli {

enum class RigNeed {
    required,
    optional,
    with_camera  ///< required, and the command has a camera of its own, which --camera-rotation turns
};

/// Which of the rig's numbers an outcome depends on.
enum class RigNumbers { all, point, none };

/// The options by which commands take lights: a rig file, and what stands on the command line instead.
class RigOptions {
  public:
    /// Adds RIG, --point, --coefficients, --blood and --camera-rotation.
    void add_to(CLI::App& command, RigNeed need);

    bool given() const { return !rig_path_.empty(); }
    const std::string& path() const { return rig_path_; }
    /// True where an option that needs a rig was used.
    bool any_used() const { return given() || point_ || coefficients_ || blood_ || camera_degrees_; }
    /// @param why  what the outcome is, for the message
    /// @throws std::invalid_argument where an option gives a number that the outcome would not depend on
    void require_used(RigNumbers used, const std::string& why) const;
    /// The same for a table of that mode.
    void require_used(LutMode mode) const;
    /// Axes of the camera by --camera-rotation, else Blender's front view.
    glm::dmat3 camera() const;
    /// Reads the rig (JSON or *.sl) and puts the command line's numbers in place. What reading decided is
    /// told on standard error. Throws FileError and std::invalid_argument.
    LightRig read() const;

  private:
    RigNeed need_ = RigNeed::required;
    std::string rig_path_;
    std::optional<std::array<double, 3>> point_;
    std::optional<std::array<double, 3>> coefficients_;
    std::optional<std::array<double, 3>> blood_;
    std::optional<std::array<double, 3>> camera_degrees_;
};

}  // namespace skinglow::cli
