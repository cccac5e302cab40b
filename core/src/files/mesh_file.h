#pragma once

#include <skinglow/mesh.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// What a mesh file says.
struct MeshFile {
    TriangleMesh mesh;                           ///< in the file's unit, axes and order of vertices
    double unit_mm = 1.0;                        ///< length of the format's unit; 1 where the format has none
    bool has_y_up = false;                       ///< whether the format says that y points up
    std::vector<std::string> notes;              ///< what was left out, for people: "... is not read"
    std::vector<std::filesystem::path> sources;  ///< all files that were read
};

/// Reads OBJ, PLY, STL, glTF and GLB; all objects with their placement in the scene, polygons cut into
/// triangles, points and lines and vertices of no face left out. STL, which repeats vertices for each triangle, is
/// read joined. docs/files.md has what is read of each format.
/// @param group  only what has this name (an OBJ's group or object, a glTF's node or mesh); empty: everything
/// @throws FileError where the file is of another format, unreadable, damaged or larger than 2 GiB,
///         has no such group (naming those that it has), no triangle, an index that points nowhere, a
///         position that is not finite, or demands an extension that is not read
MeshFile read_mesh(const std::filesystem::path& path, const std::string& group = {});

/// The mesh with each position as one vertex, in the order of their first: without the seams that texture
/// coordinates and normals make.
TriangleMesh joined(TriangleMesh mesh);

/// Writes thickness, one number in mm per vertex, by extension, whole or not at all:
/// .csv (vertex,x,y,z,thickness_mm, every digit) or .ply (binary, positions as float64, vertex property
/// thickness_mm as float32, triangles).
/// @param unit_mm  length of the mesh's unit, for the header
/// @throws FileError on another extension or where the file cannot be written, std::invalid_argument
///         where the numbers are not one per vertex or not finite
void write_thickness(const std::filesystem::path& path, const TriangleMesh& mesh,
                     std::span<const double> thickness_mm, double unit_mm);

}  // namespace skinglow::detail
