#include <skinglow/povray.h>

#include <algorithm>
#include <iterator>

#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {
namespace {

/// The file of the macros, in parts, for compilers limit the length of a literal: written by
/// povray_macros.cmake.
constexpr const char* macro_parts[] = {
#include "skinglow_inc_text.h"
};

std::string ini_text(const PovrayScene& scene) {
    SdlText text;
    text.add("; povray scene.ini\n; Linear EXR; nine samples on a fixed grid in each pixel.\n");
    text.add("Input_File_Name=scene.pov\nOutput_File_Name=scene.exr\nOutput_File_Type=E\n");
    text.add("Width=", scene.camera.width, "\nHeight=", scene.camera.height);
    text.add(
        "\nDisplay=Off\nAntialias=On\nSampling_Method=1\nAntialias_Depth=3\nAntialias_Threshold=0\nJitter="
        "Off\n");
    if (has_picture(scene.surface)) {
        // Not declared here: POV-Ray holds on to the first declaration, so that no other could be asked for.
        text.add(
            "; Needs Declare=Skinglow_Part=1 (the surface) or 2 (the glow). Their sum is the picture.\n");
    }
    return text.take();
}

std::string surface_pigment(const PovraySurface& surface) {
    SdlText text;
    if (surface.image.empty()) {
        text.add("pigment { rgb ", surface.color, " }");
    } else {
        text.add("pigment { uv_mapping image_map { ", povray_image_keyword("surface image", surface.image),
                 " ", sdl_string("surface image", surface.image), " interpolate 2 } }");
    }
    return text.take();
}

void add_include(SdlText& text, std::string_view file) {
    text.add("#include \"", file, "\"\n");
}

std::string scene_text(const PovrayScene& scene, bool lit) {
    SdlText text;
    const std::string object = "object {\n  " + mesh_identifier(scene.mesh) + "\n  texture { ";
    text.add("#version 3.7;\nglobal_settings { assumed_gamma 1.0 charset utf8 }\n");
    const bool parts = has_picture(scene.surface);
    if (parts) {
        text.add(
            "#ifndef (Skinglow_Part)\n  #error \"Skinglow_Part is not declared; allowed: 1 (the surface) or "
            "2 (the ");
        text.add("glow), as in povray scene.ini Declare=Skinglow_Part=1\\n\"\n#end\n");
    }
    add_include(text, "camera.inc");
    add_include(text, "mesh.inc");
    if (parts) text.add("#if (Skinglow_Part = 1)\n");
    if (scene.background != glm::dvec3(0.0)) text.add("background { rgb ", scene.background, " }\n");
    if (lit) add_include(text, "lights.inc");
    if (parts) {
        add_include(text, "skinglow.inc");
        text.add(object, "Skinglow_Surface(" + surface_pigment(*scene.surface) + ", 1) }\n}\n#else\n");
    }
    add_include(text, "lut.inc");
    if (scene.surface && !parts) {
        text.add(object, "Skinglow_Skin(" + surface_pigment(*scene.surface) +
                             ", 1, Skinglow_Lookup, Skinglow_Strength) }\n}\n");
    } else {
        text.add(object, "Skinglow_Glow(Skinglow_Lookup, Skinglow_Strength) }\n}\n");
    }
    if (parts) text.add("#end\n");
    return text.take();
}

}  // namespace

std::map<std::string, std::string> povray_files(const PovrayScene& scene) {
    if (has_picture(scene.surface)) povray_image_keyword("surface image", scene.surface->image);
    validate(scene.mesh, scene.surface, scene.lut.glow);
    validate(scene.camera);
    validate(scene.lut);
    require_not_negative("background", scene.background);
    if (scene.surface) require_not_negative("surface color", scene.surface->color);
    const MeshView geometry = scene.mesh.geometry;
    std::vector<Light> lights_on;
    std::copy_if(scene.lights.begin(), scene.lights.end(), std::back_inserter(lights_on), is_on);
    const bool lit = scene.surface && !lights_on.empty();
    std::map<std::string, std::string> files = {{"scene.ini", ini_text(scene)},
                                                {"scene.pov", scene_text(scene, lit)},
                                                {"camera.inc", povray_camera_text(scene.camera)},
                                                {"mesh.inc", povray_mesh_text(scene)},
                                                {"lut.inc", povray_lut_text(scene.lut, lights_on)},
                                                {"skinglow.inc", povray_macros()}};
    if (lit) files["lights.inc"] = povray_lights_text(lights_on, *box_of(std::span(&geometry, 1)));
    return files;
}

const std::string& povray_macros() {
    static const std::string text = [] {
        std::string whole;
        for (const char* part : macro_parts) whole += part;
        return whole;
    }();
    return text;
}

}  // namespace skinglow
