#pragma once

#include <skinglow/povray.h>

#include "numerics/detail.h"

/// The files behind povray_files, one function each.
namespace skinglow::detail {

/// Each checks its part of the scene first; std::invalid_argument names the field.
void validate(const PovrayMesh& mesh, const std::optional<PovraySurface>& surface, PovrayGlow glow);
void validate(const PovrayCamera& camera);
void validate(const PovrayLut& lut);

/// Whether the surface's color is an image, so that the scene is rendered in two parts.
inline bool has_picture(const std::optional<PovraySurface>& surface) {
    return surface && !surface->image.empty();
}

std::string mesh_identifier(const PovrayMesh& mesh);

std::string povray_mesh_text(const PovrayScene& scene);
std::string povray_camera_text(const PovrayCamera& camera);
std::string povray_lights_text(const std::vector<Light>& lights_on, const Box& bounds);
std::string povray_lut_text(const PovrayLut& lut, const std::vector<Light>& lights_on);

/// Refuses a file name with a folder in it, an empty one, or one whose type POV-Ray does not read.
/// @return POV-Ray's keyword for the type, "exr" or another
std::string_view povray_image_keyword(std::string_view field, std::string_view file);

}  // namespace skinglow::detail
