#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {
namespace {

void set_centered_window(PovrayCamera& camera, double width, const glm::dvec2& shift) {
    const double aspect = static_cast<double>(camera.height) / static_cast<double>(camera.width);
    const glm::dvec2 half(0.5 * width, 0.5 * width * aspect);
    // Blender counts shift in the longer side of the picture.
    const glm::dvec2 center = shift * 2.0 * std::max(half.x, half.y);
    camera.window_min = center - half;
    camera.window_max = center + half;
}

/// Axis of the camera in the world, without the matrix's scale.
glm::dvec3 axis(const PovrayCamera& camera, int column) {
    return unit(glm::dvec3(camera.matrix_world[column]));
}

}  // namespace

void set_projection(PovrayCamera& camera, const glm::dmat4& projection) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            require_finite("camera projection[" + std::to_string(row) + "][" + std::to_string(column) + "]",
                           projection[column][row]);
        }
    }
    // The last row makes w: -z for a perspective, 1 for an orthographic projection. w is only known up to a
    // factor.
    const double by_depth = -projection[2][3];
    const double constant = projection[3][3];
    const bool perspective = by_depth > 0.0 && constant == 0.0;
    const bool orthographic = by_depth == 0.0 && constant > 0.0;
    if (!(perspective || orthographic) || !(projection[0][0] > 0.0) || !(projection[1][1] > 0.0)) {
        refuse_argument(
            "camera projection",
            "of last row (" + to_text(projection[0][3]) + ", " + to_text(projection[1][3]) + ", " +
                to_text(projection[2][3]) + ", " + to_text(projection[3][3]) + ") and diagonal (" +
                to_text(projection[0][0]) + ", " + to_text(projection[1][1]) + ", ...)",
            "last row (0, 0, -1, 0) for perspective or (0, 0, 0, 1) for orthographic, diagonal above 0");
    }
    const double w = perspective ? by_depth : constant;
    for (int k = 0; k < 2; ++k) {
        // Solved for the coordinate that the picture's edges, -1 and 1, see at depth 1 (perspective) or at
        // any depth (orthographic).
        const double offset = perspective ? projection[2][k] : -projection[3][k];
        camera.window_min[k] = (-w + offset) / projection[k][k];
        camera.window_max[k] = (w + offset) / projection[k][k];
    }
    camera.projection = perspective ? PovrayProjection::perspective : PovrayProjection::orthographic;
}

void set_field_of_view(PovrayCamera& camera, double angle_x, const glm::dvec2& shift) {
    if (!(angle_x > 0.0 && angle_x < std::numbers::pi)) {
        refuse_argument("camera angle_x", to_text(angle_x), "an angle above 0 and below pi radians");
    }
    camera.projection = PovrayProjection::perspective;
    set_centered_window(camera, 2.0 * std::tan(0.5 * angle_x), shift);
}

void set_orthographic(PovrayCamera& camera, double width, const glm::dvec2& shift) {
    camera.projection = PovrayProjection::orthographic;
    set_centered_window(camera, require_positive("camera width", width), shift);
}

namespace detail {

void validate(const PovrayCamera& camera) {
    constexpr std::uint32_t max_size = 65535;
    require_between("camera width", camera.width, 1U, max_size, " pixels");
    require_between("camera height", camera.height, 1U, max_size, " pixels");
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3 vector(camera.matrix_world[column]);
        require_finite("camera matrix_world column " + std::to_string(column), vector);
        if (column < 3 && vector == glm::dvec3(0.0)) {
            refuse_argument("camera matrix_world column " + std::to_string(column), to_text(vector),
                            "a vector of length above 0");
        }
    }
    for (int k = 0; k < 2; ++k) {
        require_finite("camera window_min", camera.window_min[k]);
        require_finite("camera window_max", camera.window_max[k]);
        require_positive("camera window size", camera.window_max[k] - camera.window_min[k]);
    }
}

std::string povray_camera_text(const PovrayCamera& camera) {
    const bool perspective = camera.projection == PovrayProjection::perspective;
    const glm::dvec3 right = axis(camera, 0);
    const glm::dvec3 up = axis(camera, 1);
    const glm::dvec3 ahead = -axis(camera, 2);
    const glm::dvec2 center = 0.5 * camera.window_min + 0.5 * camera.window_max;
    const glm::dvec2 size = camera.window_max - camera.window_min;
    glm::dvec3 location(camera.matrix_world[3]);
    glm::dvec3 direction = ahead;
    // A shifted picture: a perspective's central ray leans, an orthographic camera moves aside.
    (perspective ? direction : location) += center.x * right + center.y * up;
    SdlText text;
    text.add("// No look_at: it would mirror the picture of a right-handed scene.\ncamera {\n");
    text.add(perspective ? "  perspective\n" : "  orthographic\n");
    text.add("  location ", location, "\n  direction ", direction);
    text.add("\n  right ", size.x * right, "\n  up ", size.y * up, "\n}\n");
    return text.take();
}

}  // namespace detail
}  // namespace skinglow
