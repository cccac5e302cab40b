#include <system_error>
#include <utility>

#include "files/mesh_builder.h"
#include "geometry/weld.h"

namespace skinglow::detail {

MeshFile read_mesh(const std::filesystem::path& path, const std::string& group) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "is not a file", "check the name");
    if (std::filesystem::file_size(path, error) > max_mesh_bytes) {
        refuse_file(path, "is larger than 2 GiB", "cut away what is not skin, or reduce the mesh");
    }
    const std::string extension = small_extension(path);
    const auto refuse_any_group = [&] {
        if (!group.empty())
            refuse_file(path, "has no group \"" + group + "\"", "the format has none; read all of it");
    };
    MeshFile file;
    if (extension == ".obj") {
        file = read_obj(path, group);
    } else if (extension == ".glb" || extension == ".gltf") {
        file = read_gltf(path, group);
    } else if (extension == ".ply") {
        refuse_any_group();
        file = read_ply(path);
    } else if (extension == ".stl") {
        refuse_any_group();
        file = read_stl(path);
    } else {
        refuse_file(path, "is not of a mesh format that is read",
                    "give an OBJ, PLY, STL, glTF or GLB file; Blender can open others and export it as GLB");
    }
    file.sources.insert(file.sources.begin(), path);
    return file;
}

TriangleMesh joined(TriangleMesh mesh) {
    const std::vector<Repeated> repeated = repeated_entries<glm::dvec3>(mesh.vertices());
    if (repeated.empty()) return mesh;
    const Weld welded = keep_once(mesh.vertices().size(), repeated);
    std::vector<glm::dvec3> vertices;
    vertices.reserve(welded.first.size());
    for (const std::uint32_t i : welded.first) vertices.push_back(mesh.vertices()[i]);
    std::vector<glm::uvec3> triangles = mesh.triangles();
    for (glm::uvec3& t : triangles) t = {welded.index[t.x], welded.index[t.y], welded.index[t.z]};
    return {std::move(vertices), std::move(triangles)};
}

}  // namespace skinglow::detail
