#pragma once

#include <skinglow/mesh.h>

#include <filesystem>
#include <string>

namespace skinglow {

/// Reads OBJ, PLY, GLB, glTF and what else Assimp knows; all objects with their placement in the scene,
/// polygons cut into triangles, points and lines left out. Each position is one vertex: what files split for
/// normals and texture coordinates is joined again. In the file's unit and axes.
/// @param group  only what has this name (an OBJ's group or object, a glTF's node or mesh); empty: everything
/// Throws FileError where the file is unreadable, damaged or larger than 2 GiB, has no such group (naming
/// those that it has), no triangle, an index that points nowhere or a position that is not finite.
TriangleMesh read_mesh(const std::filesystem::path& path, const std::string& group = {});

/// Writes thickness, one number in mm per vertex, by extension, whole or not at all:
/// .csv (vertex,x,y,z,thickness_mm, every digit) or .ply (binary, float32, vertex property thickness_mm,
/// triangles).
/// @param unit_mm  length of the mesh's unit, for the header Throws FileError on another extension or where
/// the file cannot be written, std::invalid_argument where the numbers are not one per vertex or not finite.
void write_thickness(const std::filesystem::path& path, const TriangleMesh& mesh,
                     std::span<const double> thickness_mm, double unit_mm);

}  // namespace skinglow
