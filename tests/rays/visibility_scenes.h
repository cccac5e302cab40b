#pragma once

#include <gtest/gtest.h>
#include <skinglow/occlusion.h>
#include <skinglow/rig.h>

#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh_shapes.h"
#include "random_lights.h"

/// Lights, and what stands before them, for the tests of visibility.
namespace skinglow::visibility_scenes {

using shapes::Mesh;
constexpr double pi = std::numbers::pi;
inline const glm::dvec3 up(0, 0, 1);

inline Occluders occluders_of(const std::vector<Mesh>& meshes,
                              const std::optional<glm::dvec3>& origin = std::nullopt) {
    std::vector<MeshView> views;
    for (const Mesh& mesh : meshes) {
        views.emplace_back(mesh.vertices, mesh.triangles, "meshes[" + std::to_string(views.size()) + "] ");
    }
    return Occluders(views, origin);
}

/// An upright-or-flat rectangle: corner, and two edges.
inline Mesh sheet(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b) {
    return {{corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Covers x > `from_x` at that height.
inline Mesh half_plane(double from_x, double height) {
    return sheet({from_x, -1000, height}, {1000, 0, 0}, {0, 2000, 0});
}

inline Mesh moved(Mesh mesh, const glm::dvec3& by, double scale = 1.0) {
    for (glm::dvec3& v : mesh.vertices) v = v * scale + by;
    return mesh;
}

inline FlatLight point_light(const glm::dvec3& position) {
    FlatLight light;
    light.position = position;
    return light;
}

inline FlatLight area_light(AreaShape shape, double size_x, double size_y, double height) {
    FlatLight light;
    light.kind = LightKind::area;
    light.area_shape = shape;
    light.size_x = size_x;
    light.size_y = size_y;
    light.position = {0, 0, height};
    return light;
}

inline double visible(const Occluders& occluders, const Light& light, const glm::dvec3& point = glm::dvec3(0),
                      const glm::dvec3& normal = up, const VisibilityOptions& options = {}) {
    const VisibleFraction found = visible_fraction(occluders, {light}, {&point, 1}, {&normal, 1}, options);
    EXPECT_DOUBLE_EQ(found.mean[0], found.at_points[0]);
    return found.mean[0];
}

inline std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace skinglow::visibility_scenes
