#pragma once

#include <skinglow/povray.h>

#include "numerics/detail.h"

/// The files behind povray_files, one function each.
namespace skinglow::detail {

/// Each checks its part of the scene first; std::invalid_argument names the field.
void validate(const PovrayScene& scene, const PovrayMesh& mesh);
void validate(const PovrayCamera& camera);
void validate(const PovrayLut& lut);
void validate(const PovrayFrames& frames);

inline bool has_picture(const std::optional<PovraySurface>& surface) {
    return surface && !surface->image.empty();
}

/// Whether the scene is rendered in two parts: the surface's picture and the lookup have uv coordinates of
/// their own each, and mesh2 has one set.
inline bool is_in_parts(const PovrayScene& scene) {
    return has_picture(scene.surface) && !scene.lut.thickness;
}

/// Whether the mesh has the uv coordinates of pictures alone.
inline bool has_own_uv(const PovrayScene& scene) {
    return scene.lut.thickness.has_value();
}

/// Whether the lookup is computed from the lights in the scene's text.
inline bool computes_from_lights(const PovrayLut& lut) {
    return lut.glow == PovrayGlow::macros && lut.mode != LutMode::existing;
}

std::string mesh_identifier(const PovrayMesh& mesh);

std::string povray_ini_text(const PovrayScene& scene);
std::string povray_mesh_text(const PovrayScene& scene);
std::string povray_camera_text(const PovrayCamera& camera);
std::string povray_lights_text(const std::vector<Light>& lights_on, const Box& bounds);
std::string povray_lut_text(const PovrayLut& lut);
std::string povray_columns_text(const PovrayLut& lut);

/// Refuses a file name with a folder in it, an empty one, or one whose type POV-Ray does not read.
/// @return POV-Ray's keyword for the type, "exr" or another
std::string_view povray_image_keyword(std::string_view field, std::string_view file);

}  // namespace skinglow::detail
