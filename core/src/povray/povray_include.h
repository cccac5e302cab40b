#pragma once

#include <map>
#include <string>

#include "povray/povray_scene.h"

namespace skinglow {

/// The files of a POV-Ray 3.7 scene, by name; only those that it uses. Text alone: whoever calls writes them,
/// all into one folder, besides the pictures that the scene names. Rendered from within the folder: POV-Ray's
/// Debian set-up lets it read nothing outside of the working directory.
///
///   scene.ini     size and options: `povray scene.ini` gives scene.exr; `povray scene.ini +OFILE` another
///   name scene.pov     the skin; with a picture on the surface `Declare=Skinglow_Part=1` renders the surface
///   and 2 the
///                 glow, which are to be added
///   lut.inc       axis, strength; the EXR's name, or base lookup, weights, coefficients and lamps as SDL
///   values mesh.inc      mesh2 camera.inc    location, direction, right, up lights.inc    light_source of
///   each lamp that is on (not without a surface or without lamps) skinglow.inc  the macros
///   (povray_macros/skinglow.inc)
///
/// Numbers have all digits that they need to be read back as the same double. The same scene gives the same
/// text. Throws std::invalid_argument, naming the field, the value and what is allowed, on wrong sizes,
/// indices out of range, non-finite numbers, file names that POV-Ray cannot take, or a mode that the macros
/// do not compute.
std::map<std::string, std::string> povray_files(const PovrayScene& scene);

/// The text of povray_macros/skinglow.inc.
const std::string& povray_macros();

}  // namespace skinglow
