// POV-Ray scenes with any names and numbers: quotes, braces and parentheses stay balanced outside of strings and comments,
// and no number is one that POV-Ray does not know.

#include <skinglow/povray.h>

#include <string>
#include <string_view>

#include "fuzz_lights.h"
#include "fuzz_mesh.h"

namespace {

using skinglow::fuzz::require;

/// What of the text is code: without comments and the insides of strings.
std::string code_of(std::string_view text) {
    std::string code;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text.substr(i, 2) == "//") {
            while (i < text.size() && text[i] != '\n') ++i;
            code += '\n';
        } else if (text.substr(i, 2) == "/*") {
            i = text.find("*/", i + 2);
            require(i != std::string_view::npos, "a comment ends");
            ++i;
        } else if (text[i] == '"') {
            code += '"';
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                if (text[i] == '\\') ++i;
            }
            require(i < text.size(), "a string ends");
        } else {
            code += text[i];
        }
    }
    return code;
}

void check_sdl(const std::string& text) {
    const std::string code = code_of(text);
    int braces = 0;
    int parentheses = 0;
    for (const char c : code) {
        braces += (c == '{') - (c == '}');
        parentheses += (c == '(') - (c == ')');
        require(braces >= 0 && parentheses >= 0, "a brace is opened before it is closed");
        require(static_cast<unsigned char>(c) < 128, "code is ASCII");
    }
    require(braces == 0 && parentheses == 0, "braces are closed");
    for (const std::string_view word : {"nan,", "inf,", "-nan", "nan>", "inf>"})
        require(code.find(word) == std::string::npos, "numbers are numbers");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    PovrayScene scene;
    scene.mesh.name = input.text(12);
    scene.background = input.vector_in(0.0, 1.0);
    scene.camera.width = static_cast<std::uint32_t>(input.below(4000));
    scene.camera.height = static_cast<std::uint32_t>(input.below(4000));
    scene.lut.mode = static_cast<LutMode>(input.below(3));
    scene.lut.glow = static_cast<PovrayGlow>(input.below(3));
    if (scene.lut.glow != PovrayGlow::macros) scene.lut.image = input.text(12);
    scene.lut.strength = input.near_range(0.0, 2.0);
    scene.lut.point = input.vector_in(-1.0, 1.0);
    scene.lut.world_irradiance = input.vector_in(0.0, 1.0);
    runs([&] { scene.lut.axis = LutAxis(2 + input.below(3), input.near_decades(1.0, 20.0)); });
    scene.lut.base.assign(scene.lut.axis.size(), input.near_range(0.0, 1.0));
    scene.lut.matrices.assign(scene.lut.axis.size(), glm::dmat3(input.near_range(0.0, 1.0)));
    if (input.flag())
        scene.lut.thickness = PovrayThicknessPicture{input.text(8), input.number(), input.number()};
    if (input.flag()) scene.surface = PovraySurface{input.vector_in(0.0, 1.0), input.text(8)};
    if (input.flag())
        scene.frames =
            PovrayFrames{static_cast<int>(input.below(9)), static_cast<int>(input.below(9)), input.number()};
    const auto mesh = mesh_from(input);
    if (!mesh) return 0;
    scene.mesh.geometry = *mesh;
    const std::size_t vertices = mesh->vertices().size();
    if (input.flag()) scene.mesh.lut_u.assign(vertices, input.near_range(0.0, 1.0));
    if (input.flag()) scene.mesh.vertex_normals.assign(vertices, input.vector_in(-1.0, 1.0));
    if (input.flag())
        scene.mesh.surface_uv.assign(3 * mesh->triangles().size(), {input.number(), input.number()});
    scene.lights = lights_from(input, 3);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        LightSettings named = scene.lights[i].settings();
        named.name = input.text(10);
        scene.lights[i] = named;
    }
    runs([&] {
        for (const auto& [name, text] : povray_files(scene)) {
            require(name.find('/') == std::string::npos, "a file's name has no folder");
            if (name.ends_with(".inc") || name.ends_with(".pov")) check_sdl(text);
        }
    });
    return 0;
}
