#pragma once

#include <skinglow/lut.h>

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "light/light.h"
#include "light/light_weights.h"

/// What a POV-Ray scene is written from, in plain numbers: world coordinates as Blender has them
/// (right-handed, z up), one unit of length a meter for the lamps, radians, linear Rec.709.
namespace skinglow {

/// Triangles in world space. Vertices that no triangle uses are left out of the file.
struct PovrayMesh {
    std::string name = "skin";          ///< any text; becomes the SDL identifier Skinglow_Mesh_<name>
    std::vector<glm::dvec3> positions;  ///< finite
    std::vector<glm::uvec3> triangles;  ///< indices into positions; at least one triangle
    /// Image coordinate of each vertex in the lookup: axis.texel_scale() * thickness + axis.texel_offset().
    /// It is clamped to the centers of the first and the last texel on writing. Finite; as many as positions.
    std::vector<double> lut_u;
    /// Smooth shading: one normal per position, or three per triangle, not both; none: flat. Finite; a normal
    /// of length 0, as hosts give at triangles without area, becomes +z. Written only where the scene has a
    /// surface: glow alone does not need them.
    std::vector<glm::dvec3> vertex_normals;
    std::vector<glm::dvec3> corner_normals;
    /// Coordinates of the surface's picture, three per triangle, v up; needed only with PovraySurface::image.
    std::vector<glm::dvec2> surface_uv;
};

enum class PovrayProjection { perspective, orthographic };

/// A camera as Blender has it: it looks along its own -z, +x is right and +y up.
struct PovrayCamera {
    PovrayProjection projection = PovrayProjection::perspective;
    glm::dmat4 matrix_world{1.0};  ///< camera to world, column vectors; its scale is ignored, as in Blender
    /// What the picture covers: perspective, at distance 1 before the camera; orthographic, in scene units.
    glm::dvec2 window_low{-0.36, -0.36};
    glm::dvec2 window_high{0.36, 0.36};
    std::uint32_t width = 512;   ///< pixels, 1 to 65535
    std::uint32_t height = 512;  ///< pixels, 1 to 65535
};

/// Sets projection and window from the 4x4 projection matrix of the picture (column vectors, as OpenGL and
/// Blender's `camera.calc_matrix_camera(depsgraph, x=width, y=height)` have it): sensor fit, shift and pixel
/// aspect are all in it. Throws std::invalid_argument where it is neither a perspective nor an orthographic
/// projection.
void set_projection(PovrayCamera& camera, const glm::dmat4& projection);

/// Sets a perspective window from the full angle that the picture's width covers, radians, above 0 and below
/// pi, for square pixels. @param shift  of the picture, in shares of its longer side, as Blender has it
void set_field_of_view(PovrayCamera& camera, double angle_x, const glm::dvec2& shift = glm::dvec2(0.0));

/// Sets an orthographic window from the width it covers, scene units, above 0, for square pixels.
void set_orthographic(PovrayCamera& camera, double width, const glm::dvec2& shift = glm::dvec2(0.0));

/// The brightness of a gray base lookup, as PovrayLut::base wants it. Throws std::invalid_argument, naming
/// the entry, where a matrix is not a multiple of the identity.
std::vector<double> gray_entries(const BaseLut& base);

/// Where the glow takes its colors from.
enum class PovrayGlow {
    image,  ///< the float EXR `image`, one row; POV-Ray 3.7 reads it as half floats (11 bits)
    macros  ///< computed by skinglow.inc from the base and the lamps, in doubles; modes existing and paper
};

struct PovrayLut {
    LutMode mode = LutMode::paper;
    LutAxis axis{default_lut_size, default_max_thickness_mm};
    PovrayGlow glow = PovrayGlow::macros;
    std::string image;  ///< of PovrayGlow::image: EXR in the scene's folder, name without a folder
    std::vector<double>
        base;  ///< of mode paper by macros: the gray base lookup, axis.size() entries, 0 or more
    glm::dvec3 blood_weight = paper_blood_weight;  ///< B of Eq. 1
    AttenuationCoefficients coefficients;          ///< of Eq. 2
    glm::dvec3 point{0.0};  ///< world point that the distances of Eq. 2 are measured to
    double strength = 1.0;  ///< radiance shown = strength * table; 0 or more
};

/// A matt surface under the glow.
struct PovraySurface {
    glm::dvec3 color{0.8};  ///< linear Rec.709, 0 or more; multiplies the picture
    /// Picture in the scene's folder, by extension png, jpg, tif, exr or hdr; empty: one color. With a
    /// picture the scene is rendered twice and summed: mesh2 has one set of uv coordinates (docs/povray.md).
    std::string image;
};

struct PovrayScene {
    PovrayMesh mesh;
    PovrayCamera camera;
    /// Those that are off are left out. Blender's units (hosts' own factors folded in, light.h).
    std::vector<Light> lights;
    PovrayLut lut;
    std::optional<PovraySurface>
        surface;                 ///< none: only the light that comes through, no light_source is needed
    glm::dvec3 background{0.0};  ///< linear Rec.709 radiance, 0 or more
};

}  // namespace skinglow
