#include <cmath>
#include <string>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "rig/rig_data.h"

namespace skinglow {

SurfacePoints far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                       std::span<const double> depth) {
    require_surface(vertices, normals);
    if (depth.size() != vertices.size() && depth.size() != 1) {
        refuse_argument("number of depths", std::to_string(depth.size()),
                        "1 or as many as vertices (" + std::to_string(vertices.size()) + ")");
    }
    for (std::size_t i = 0; i < depth.size(); ++i) {
        // The name is only put together where it is needed: this is a large part of the time otherwise.
        if (!(depth[i] >= 0.0 && std::isfinite(depth[i])))
            require_not_negative("depth[" + std::to_string(i) + "]", depth[i]);
    }
    SurfacePoints far{std::vector<glm::dvec3>(vertices.size()), std::vector<glm::dvec3>(vertices.size())};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (normals[i] != glm::dvec3(0.0)) far.normals[i] = -unit(normals[i]);
        far.points[i] = vertices[i] + far.normals[i] * (depth.size() == 1 ? depth[0] : depth[i]);
    }
    return far;
}

std::vector<glm::dvec3> far_side_irradiance(const PreparedRig& rig, std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth, const SurfaceOptions& options) {
    const SurfacePoints far = far_side(vertices, normals, depth);
    return surface_irradiance(rig, far.points, far.normals, options);
}

}  // namespace skinglow
