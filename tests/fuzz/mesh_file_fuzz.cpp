// A mesh file of one format (MESH_EXTENSION): finite positions and triangles that point at them, or a refusal; what is
// written of it reads back equal.

#include <vector>

#include "file_target.h"
#include "files/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::detail;
    using namespace skinglow::fuzz;
    const auto path = written("mesh" MESH_EXTENSION, data, size);
    reads(path, [&] {
        const TriangleMesh mesh = read_mesh(path).mesh;
        require(!mesh.triangles().empty(), "a mesh has a triangle");
        for (const glm::dvec3& vertex : mesh.vertices()) require(is_finite(vertex), "positions are finite");
        for (const glm::uvec3& t : mesh.triangles()) {
            const std::size_t n = mesh.vertices().size();
            require(t.x < n && t.y < n && t.z < n, "triangles point at vertices");
        }
        const auto again = scratch_file("again.ply");
        write_thickness(again, mesh, std::vector<double>(mesh.vertices().size(), 1.0), 1.0);
        const TriangleMesh same = read_mesh(again).mesh;
        require(same.triangles() == mesh.triangles(), "a mesh reads back equal");
        require(same.vertices() == mesh.vertices(), "positions read back equal");
    });
    return 0;
}
