// Thickness of small meshes: finite, from 0 to the diagonal of the box.

#include <skinglow/thickness.h>

#include <glm/geometric.hpp>
#include <vector>

#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    ThicknessOptions options;
    options.unit_mm = input.near_decades(0.1, 1000.0);
    options.rays = static_cast<int>(1 + input.below(16));
    options.cone_half_angle = input.near_range(0.0, 1.5);
    options.min_sky_visibility = input.flag() ? 0.0 : input.near_range(0.0, 1.0);
    options.threads = 1;
    const auto mesh = mesh_from(input);
    if (!mesh) return 0;
    runs([&] {
        const ThicknessReport report = thickness_report(*mesh, options);
        require(report.mm.size() == mesh->vertices().size(), "one thickness for each vertex");
        if (report.mm.empty()) return;
        const Box box = box_of(mesh->vertices());
        const double diagonal = 2 * box.radius() * options.unit_mm;
        for (const double mm : report.mm)
            require(std::isfinite(mm) && mm >= 0 && mm <= diagonal * (1 + 1e-9),
                    "a thickness is within the mesh");
    });
    return 0;
}
