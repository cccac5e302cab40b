#pragma once

#include <skinglow/light.h>

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A camera's axes in the world, as columns: right, up, and back (from what it sees to its eye).
/// Blender's front view, which looks along +Y: right +X, up +Z, back -Y. Each column to the last bit of what
/// Blender's rotation of 90 degrees about X would be.
constexpr glm::dmat3 front_view{{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};

/// The axes of a camera whose Blender rotation (mode XYZ Euler) is this, radians; (pi/2, 0, 0) is
/// `front_view` but for rounding. Throws std::invalid_argument on a rotation that is not finite.
glm::dmat3 camera_axes(const glm::dvec3& euler_xyz);

struct StudioLight {
    std::vector<Light> lights;       ///< suns named "light[i]", those that are on
    std::vector<std::string> notes;  ///< what the format holds and a sun cannot: ambient light, soft wrap
};

/// Power of the suns, W/m^2: a white Lambert surface that faces the light then has the radiance `col` of the
/// file, which is what Blender's solid view shows (radiance = irradiance / pi). Mode `paper` does not look at
/// it.
constexpr double studio_light_power = std::numbers::pi;

/// Reads one of Blender's studio lights (*.sl), format version 1: lines "key value", four lights light[0] to
/// light[3], each with flag (1 on, 0 off), smooth, col (diffuse, linear), spec (highlights, left out here)
/// and vec, the direction TOWARDS the light in view space: x right, y up, z towards the viewer. Each becomes a
/// sun that shines along -vec.
/// @param camera  axes of the view that the lights hang on; orthonormal, else std::invalid_argument
/// Throws FileError, naming line and key, on anything else, on a missing key and on a number that is not
/// finite.
StudioLight read_studio_light(const std::filesystem::path& path, const glm::dmat3& camera = front_view);

}  // namespace skinglow::detail
