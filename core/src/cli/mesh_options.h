#pragma once

#include <skinglow/thickness.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace skinglow::cli {

/// The options by which commands take a mesh and measure its thickness.
class MeshOptions {
  public:
    /// Adds the mesh under the given name ("MESH" or "--mesh"), --unit, --group, --rays and
    /// --min-sky-visibility.
    void add_to(CLI::App& command, const std::string& mesh_name);

    double unit_mm() const { return thickness_.unit_mm; }
    /// Reads the mesh; the unit is that of its format where --unit does not say. Each position is one vertex. Tells what was left out.
    /// @throws FileError
    TriangleMesh read();
    /// Whether y points up in files of its format, after `read`: so says glTF alone.
    bool has_y_up() const { return has_y_up_; }
    /// The files that were read.
    const std::vector<std::filesystem::path>& sources() const { return sources_; }
    /// One per vertex, mm; shows how far it is to a person who waits.
    std::vector<double> measure(const TriangleMesh& mesh) const;

  private:
    std::string path_;
    std::string group_;
    ThicknessOptions thickness_;
    std::optional<double> unit_mm_;  ///< of --unit
    bool has_y_up_ = false;
    std::vector<std::filesystem::path> sources_;
};

}  // namespace skinglow::cli
