#include <skinglow/povray.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
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

/// The mesh at all of its places, as far as the texture.
std::string object_text(const PovrayMesh& mesh) {
    const std::string name = mesh_identifier(mesh);
    if (mesh.instances.empty()) return "object {\n  " + name + "\n";
    SdlText text;
    text.add("union {\n  object { ", name, " }\n");
    for (const glm::dmat4& place : mesh.instances) {
        text.add("  object { ", name, " matrix <");
        for (int column = 0; column < 4; ++column) {
            text.add(column > 0 ? ", " : "", place[column].x, ",", place[column].y, ",", place[column].z);
        }
        text.add("> }\n");
    }
    return text.take();
}

/// Around the mesh at all of its places.
Box bounds_of(const PovrayMesh& mesh) {
    const MeshView geometry = mesh.geometry;
    Box bounds = *box_of(std::span(&geometry, 1));
    const std::array<glm::dvec3, 2> ends = {bounds.min, bounds.max};
    for (const glm::dmat4& place : mesh.instances) {
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const glm::dvec3 point(ends[corner & 1U].x, ends[(corner >> 1U) & 1U].y, ends[corner >> 2U].z);
            const glm::dvec3 moved(place * glm::dvec4(point, 1.0));
            bounds.min = glm::min(bounds.min, moved);
            bounds.max = glm::max(bounds.max, moved);
        }
    }
    return bounds;
}

/// Makes light sources: in a scene of two parts only the first has a surface that they light.
std::string_view light_sources(const PovrayScene& scene) {
    if (is_in_parts(scene)) return "(Skinglow_Part = 1 ? 1 : 0)";
    return scene.surface ? "1" : "0";
}

std::string scene_text(const PovrayScene& scene, bool with_lights) {
    SdlText text;
    const std::string object = object_text(scene.mesh) + "  texture { ";
    text.add("#version 3.7;\nglobal_settings { assumed_gamma 1.0 charset utf8 }\n");
    const bool parts = is_in_parts(scene);
    if (parts) {
        text.add(
            "#ifndef (Skinglow_Part)\n  #error \"Skinglow_Part is not declared; allowed: 1 (the surface) or "
            "2 (the ");
        text.add("glow), as in povray scene.ini Declare=Skinglow_Part=1\\n\"\n#end\n");
    }
    add_include(text, "skinglow.inc");
    if (with_lights) text.add("#declare Skinglow_Light_Sources = ", light_sources(scene), ";\n");
    add_include(text, "camera.inc");
    add_include(text, "mesh.inc");
    if (with_lights) add_include(text, "lights.inc");
    if (parts) text.add("#if (Skinglow_Part = 1)\n");
    if (scene.background != glm::dvec3(0.0)) text.add("background { rgb ", scene.background, " }\n");
    if (parts) text.add(object, "Skinglow_Surface(" + surface_pigment(*scene.surface) + ", 1) }\n}\n#else\n");
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
    validate(scene, scene.mesh);
    validate(scene.camera);
    validate(scene.lut);
    if (scene.frames) validate(*scene.frames);
    require_not_negative("background", scene.background);
    if (scene.surface) require_not_negative("surface color", scene.surface->color);
    std::vector<Light> lights_on;
    std::copy_if(scene.lights.begin(), scene.lights.end(), std::back_inserter(lights_on), is_on);
    const bool computed = computes_from_lights(scene.lut);
    const bool with_lights = (scene.surface || computed) && !lights_on.empty();
    std::map<std::string, std::string> files = {{"scene.ini", povray_ini_text(scene)},
                                                {"scene.pov", scene_text(scene, with_lights)},
                                                {"camera.inc", povray_camera_text(scene.camera)},
                                                {"mesh.inc", povray_mesh_text(scene)},
                                                {"lut.inc", povray_lut_text(scene.lut)},
                                                {"skinglow.inc", povray_macros()}};
    if (computed && scene.lut.mode == LutMode::physical)
        files["columns.inc"] = povray_columns_text(scene.lut);
    if (with_lights) files["lights.inc"] = povray_lights_text(lights_on, bounds_of(scene.mesh));
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
