#pragma once

#include <skinglow/light.h>
#include <skinglow/light_weights.h>
#include <skinglow/lut.h>
#include <skinglow/mesh.h>

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// POV-Ray scenes of glowing skin, as text: world coordinates as Blender has them (right-handed, z up), one unit of
/// length a meter for the lights, radians, linear Rec.709.
///
/// @code
/// skinglow::PovrayScene scene;
/// scene.mesh.geometry = skinglow::TriangleMesh(std::move(vertices), std::move(triangles));
/// for (const double mm : skinglow::thickness(scene.mesh.geometry))
///     scene.mesh.lut_u.push_back(scene.lut.axis.texel_scale() * mm + scene.lut.axis.texel_offset());
/// scene.lut.base = skinglow::gray_entries(base);
/// scene.lights = lights;
/// skinglow::set_field_of_view(scene.camera, 0.7);
/// for (const auto& [name, text] : skinglow::povray_files(scene)) std::ofstream(folder / name) << text;
/// @endcode
namespace skinglow {

/// Triangles in world space. Vertices that no triangle uses are left out of the file.
struct PovrayMesh {
    std::string name = "skin";  ///< any text; becomes the SDL identifier Skinglow_Mesh_<name>
    TriangleMesh geometry;      ///< at least one triangle
    /// Image coordinate of each vertex in the lookup: axis.texel_scale() * thickness + axis.texel_offset().
    /// It is clamped to the centers of the first and the last texel on writing. Finite; as many as vertices, or
    /// none with PovrayLut::thickness.
    std::vector<double> lut_u;
    /// Of PovrayGlow::texels, in place of lut_u: coordinates in the image, three per triangle, v up. Between
    /// the centers of texels POV-Ray interpolates linearly in u and in v. Finite.
    std::vector<glm::dvec2> glow_uv;
    /// Smooth shading: one normal per vertex, or three per triangle, not both; none: flat. Finite, of any length; one
    /// of 0, as hosts give at triangles without area, becomes +z. Written only where the scene has a
    /// surface: glow alone does not need them.
    std::vector<glm::dvec3> vertex_normals;
    std::vector<glm::dvec3> corner_normals;
    /// Further places of the same mesh: each moves the mesh as written to where it stands once more. Affine,
    /// finite, with a determinant that is not 0.
    std::vector<glm::dmat4> instances;
    /// Coordinates of the pictures, three per triangle, v up; needed only with PovraySurface::image and
    /// PovrayLut::thickness.
    std::vector<glm::dvec2> surface_uv;
};

enum class PovrayProjection { perspective, orthographic };

/// A camera as Blender has it: it looks along its own -z, +x is right and +y up.
struct PovrayCamera {
    PovrayProjection projection = PovrayProjection::perspective;
    glm::dmat4 matrix_world{1.0};  ///< camera to world, column vectors; its scale is ignored, as in Blender
    /// What the picture covers: perspective, at distance 1 before the camera; orthographic, in scene units.
    glm::dvec2 window_min{-0.36, -0.36};
    glm::dvec2 window_max{0.36, 0.36};
    std::uint32_t width = 512;   ///< pixels, 1 to 65535
    std::uint32_t height = 512;  ///< pixels, 1 to 65535
};

/// Sets projection and window from the 4x4 projection matrix of the picture: sensor fit, shift and pixel
/// aspect are all in it.
/// @param projection  column vectors, as OpenGL and Blender's `camera.calc_matrix_camera(depsgraph, x=width,
///                    y=height)` have it
/// @throws std::invalid_argument where it is neither a perspective nor an orthographic projection
void set_projection(PovrayCamera& camera, const glm::dmat4& projection);

/// Sets a perspective window for square pixels.
/// @param angle_x  full angle that the picture's width covers, radians, above 0 and below pi
/// @param shift    of the picture, as a fraction of its longer side, as Blender has it
void set_field_of_view(PovrayCamera& camera, double angle_x, const glm::dvec2& shift = glm::dvec2(0.0));

/// Sets an orthographic window for square pixels.
/// @param width  that the picture covers, scene units, above 0
/// @param shift  as set_field_of_view
void set_orthographic(PovrayCamera& camera, double width, const glm::dvec2& shift = glm::dvec2(0.0));

/// The brightness of a gray base lookup, as PovrayLut::base wants it.
/// @throws std::invalid_argument naming the entry where a matrix is not a multiple of the identity
std::vector<double> gray_entries(const BaseLut& base);

/// Where the glow takes its colors from.
enum class PovrayGlow {
    image,   ///< the float EXR `image`, one row; POV-Ray 3.7 reads it as half floats (11 bits)
    macros,  ///< computed by skinglow.inc from the base or the skin's matrices and the lights, in doubles
    texels  ///< the float EXR `image` of any size, at the coordinates PovrayMesh::glow_uv: light that is known
            ///< at points of the skin, as Shape gives it and FaceTiles places it
};

/// Thickness as a picture in the mesh's own uv coordinates (PovrayMesh::surface_uv), as `bake_thickness` makes it.
struct PovrayThicknessPicture {
    std::string file;       ///< EXR, or PNG or TIFF of 16 bit, in the scene's folder
    double black_mm = 0.0;  ///< thickness where it is 0, finite
    double white_mm = 1.0;  ///< thickness where it is 1, finite; linear between and, in an EXR, beyond
};

struct PovrayLut {
    LutMode mode = LutMode::paper;
    LutAxis axis{default_lut_size, default_max_thickness_mm};
    PovrayGlow glow = PovrayGlow::macros;
    std::string image;  ///< of PovrayGlow::image and texels: EXR in the scene's folder, name without a folder
    std::vector<double> base;  ///< mode paper by macros: the gray base lookup, axis.size() entries, 0 or more
    std::vector<glm::dmat3>
        matrices;  ///< mode physical by macros: M(d), axis.size() entries (BaseLut::matrices)
    glm::dvec3 world_irradiance{0.0};  ///< mode physical by macros: added to that of the lights, W/m^2
    glm::dvec3 blood_weight = paper_blood_weight;  ///< B of Eq. 1
    AttenuationCoefficients coefficients;          ///< of Eq. 2
    glm::dvec3 point{0.0};  ///< world point that the distances of Eq. 2 and the irradiance are measured at
    /// By macros: the lookup's thickness, in place of PovrayMesh::lut_u. Then a surface with a picture of its own
    /// takes one render, not two.
    std::optional<PovrayThicknessPicture> thickness;
    double strength = 1.0;  ///< radiance shown = strength * table; 0 or more
};

/// A matt surface under the glow.
struct PovraySurface {
    glm::dvec3 color{0.8};  ///< linear Rec.709, 0 or more; multiplies the picture
    /// Picture in the scene's folder, by extension png, jpg, tif, exr or hdr; empty: one color. With a
    /// picture, and a thickness that is none, the scene is rendered twice and summed: mesh2 has one set of uv
    /// coordinates (docs/povray.md).
    std::string image;
};

/// Frames of an animation, numbered as the host has them; POV-Ray's clock is seconds since the first.
struct PovrayFrames {
    int first = 1;           ///< 0 or more
    int last = 1;            ///< first or more
    double per_second = 24;  ///< above 0
};

struct PovrayScene {
    PovrayMesh mesh;
    PovrayCamera camera;
    std::vector<Light> lights;  ///< those that are off are left out
    PovrayLut lut;
    std::optional<PovraySurface> surface;  ///< none: only the glow, no light_source is needed
    glm::dvec3 background{0.0};            ///< linear Rec.709 radiance, 0 or more
    std::optional<PovrayFrames> frames;    ///< none: a still
};

/// The files of a POV-Ray 3.7 scene, by name; only those that it uses. Text alone: whoever calls writes them,
/// all into one folder, besides the pictures that the scene names. Rendered from within the folder: POV-Ray's
/// Debian set-up lets it read nothing outside of the working directory.
///
/// | file         | holds                                                                                   |
/// |--------------|-----------------------------------------------------------------------------------------|
/// | scene.ini    | size, frames and options: `povray scene.ini` gives scene.exr, with `+OFILE` another     |
/// |              | file; `povray scene.ini[Preview]` a quick look, `povray scene.ini[Final]` finer edges   |
/// | scene.pov    | the skin; with a picture on its surface, `Declare=Skinglow_Part=1` renders the surface, |
/// |              | and `Declare=Skinglow_Part=2` the glow, which are to be added                           |
/// | lut.inc      | axis and strength; the EXR's name, or base lookup, weights and coefficients             |
/// | columns.inc  | the columns of M(d); mode physical by macros                                            |
/// | mesh.inc     | mesh2                                                                                   |
/// | camera.inc   | location, direction, right, up                                                          |
/// | lights.inc   | each light that is on, by Skinglow_Light: its light_source, if there is a surface to    |
/// |              | light, and what the glow is computed of. Not where nothing asks for lights              |
/// | skinglow.inc | the macros (povray_macros/skinglow*.inc, in one file)                                   |
///
/// Numbers are finite and have all digits that they need to be read back as the same double. The same scene
/// gives the same text.
/// @throws std::invalid_argument naming the field, the value and what is allowed, on wrong sizes, non-finite
///         numbers, or file names that POV-Ray cannot take
std::map<std::string, std::string> povray_files(const PovrayScene& scene);

/// A file from a frame on, until the next one of the list.
struct PovrayFrameFile {
    int first_frame = 0;
    std::string file;  ///< in the scene's folder
};

/// The text of a file of an animated scene that includes another one for each span of frames, so that what does
/// not change is written once. Without an animation it includes the first.
/// @param files  in the order of their frames, at least one
/// @throws std::invalid_argument on no files, or frames that do not rise
std::string povray_frame_choice(std::span<const PovrayFrameFile> files);

/// The text of povray_macros/skinglow.inc, with the files that it includes in their places.
const std::string& povray_macros();

}  // namespace skinglow
