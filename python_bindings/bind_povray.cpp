#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/povray.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh_arrays.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

void require_shape(const py::array& array, std::string_view name, bool fits, std::string_view wanted) {
    if (!fits) refuse_argument(name, "of shape " + numpy::shape_text(array), wanted);
}

std::vector<double> to_doubles(py::handle value, std::string_view name) {
    const numpy::Array array = numpy::to_array(value, name);
    require_shape(array, name, array.ndim() == 1, "shape (n,)");
    return {array.data(), array.data() + array.size()};
}

glm::dvec2 to_vec2(py::handle value, std::string_view name) {
    const numpy::Array array = numpy::to_array(value, name);
    require_shape(array, name, array.ndim() == 1 && array.shape(0) == 2, "shape (2,)");
    return {array.at(0), array.at(1)};
}

glm::dmat4 to_mat4(py::handle value, std::string_view name) {
    const numpy::Array array = numpy::to_array(value, name);
    require_shape(array, name, array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4,
                  "shape (4, 4)");
    glm::dmat4 matrix(0.0);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) matrix[column][row] = array.at(row, column);
    }
    return matrix;
}

void set_normals(PovrayMesh& mesh, py::handle value) {
    if (value.is_none()) return;
    const numpy::Array array = numpy::to_array(value, "normals");
    const bool by_corner = array.ndim() == 3 && array.shape(1) == 3 && array.shape(2) == 3;
    require_shape(array, "normals", by_corner || (array.ndim() == 2 && array.shape(1) == 3),
                  "shape (n, 3), one per vertex, or (m, 3, 3), three per triangle");
    const auto* rows = reinterpret_cast<const glm::dvec3*>(array.data());
    // To the core none are no normals, which is for None to say.
    if (array.size() == 0)
        refuse_argument("normals", "empty", "one per vertex or three per triangle, or None");
    (by_corner ? mesh.corner_normals : mesh.vertex_normals).assign(rows, rows + array.size() / 3);
}

std::vector<glm::dvec2> to_corner_uv(py::handle value, std::string_view name) {
    if (value.is_none()) return {};
    const numpy::Array array = numpy::to_array(value, name);
    require_shape(array, name, array.ndim() == 3 && array.shape(1) == 3 && array.shape(2) == 2,
                  "shape (m, 3, 2), three per triangle");
    const auto* rows = reinterpret_cast<const glm::dvec2*>(array.data());
    return {rows, rows + array.size() / 2};
}

PovrayGlow glow_of(const std::string& image, py::handle lut_u, py::handle glow_uv, bool by_picture) {
    if (by_picture && lut_u.is_none() && glow_uv.is_none())
        return image.empty() ? PovrayGlow::macros : PovrayGlow::image;
    if (lut_u.is_none() == glow_uv.is_none()) {
        refuse_argument("lut_u and glow_uv", lut_u.is_none() ? "neither" : "both", "one of them");
    }
    if (!glow_uv.is_none()) return PovrayGlow::texels;
    return image.empty() ? PovrayGlow::macros : PovrayGlow::image;
}

PovrayCamera to_camera(py::handle matrix, py::handle resolution, py::handle projection, py::handle angle_x,
                       py::handle ortho_width, py::handle shift) {
    PovrayCamera camera;
    const glm::dvec2 pixels = to_vec2(resolution, "resolution");
    for (int k = 0; k < 2; ++k) {
        if (!(pixels[k] >= 1.0 && pixels[k] <= 65535.0)) {
            refuse_argument("resolution", to_text(pixels[k]), "1 to 65535 pixels");
        }
    }
    camera.width = static_cast<std::uint32_t>(pixels.x);
    camera.height = static_cast<std::uint32_t>(pixels.y);
    camera.matrix_world = to_mat4(matrix, "camera_matrix");
    const int given = static_cast<int>(!projection.is_none()) + static_cast<int>(!angle_x.is_none()) +
                      static_cast<int>(!ortho_width.is_none());
    if (given != 1) {
        refuse_argument("camera", std::to_string(given) + " of projection, angle_x and ortho_width",
                        "one of them");
    }
    if (!projection.is_none()) {
        set_projection(camera, to_mat4(projection, "projection"));
    } else if (!angle_x.is_none()) {
        set_field_of_view(camera, numpy::to_number(angle_x, "angle_x"), to_vec2(shift, "shift"));
    } else {
        set_orthographic(camera, numpy::to_number(ortho_width, "ortho_width"), to_vec2(shift, "shift"));
    }
    return camera;
}

LutAxis to_axis(py::handle base, py::handle size, py::handle max_thickness_mm) {
    if (!base.is_none() && !py::isinstance<BaseLut>(base))
        refuse_argument("base", py::repr(base).cast<std::string>(), "a skinglow.BaseLut or None");
    if (!base.is_none()) return base.cast<const BaseLut&>().axis();
    if (size.is_none() || max_thickness_mm.is_none()) {
        refuse_argument("axis", "not given", "base, or size and max_thickness_mm");
    }
    if (!py::isinstance<py::int_>(size) && PyIndex_Check(size.ptr()) == 0)
        refuse_argument("size", py::repr(size).cast<std::string>(), "1 to 65536 entries");
    const double entries = numpy::to_number(size, "size");
    if (!(entries >= 1 && entries <= 65536)) refuse_argument("size", to_text(entries), "1 to 65536 entries");
    return {static_cast<std::size_t>(entries), numpy::to_number(max_thickness_mm, "max_thickness_mm")};
}

std::map<std::string, std::string> povray_files_of_arrays(
    py::handle vertices, py::handle triangles, py::handle lut_u, py::handle camera_matrix,
    py::handle resolution, py::handle projection, py::handle angle_x, py::handle ortho_width,
    py::handle shift, std::string_view mode, py::handle base, py::handle size, py::handle max_thickness_mm,
    std::string image, std::vector<Light> lights, py::handle point, py::handle coefficients,
    py::handle blood_weight, double strength, py::handle normals, py::handle surface_color,
    std::string surface_image, py::handle surface_uv, py::handle background, std::string name,
    py::handle glow_uv, py::handle world_irradiance, std::string thickness_image, py::handle thickness_range,
    std::optional<std::tuple<int, int, double>> frames, const std::vector<py::object>& instances) {
    PovrayScene scene;
    scene.mesh.name = std::move(name);
    scene.mesh.geometry = numpy::to_mesh(vertices, triangles);
    if (!lut_u.is_none()) {
        scene.mesh.lut_u = to_doubles(lut_u, "lut_u");
        require_count("lut_u", scene.mesh.lut_u.size(), scene.mesh.geometry.vertices().size(),
                      "one per vertex");
    }
    scene.mesh.glow_uv = to_corner_uv(glow_uv, "glow_uv");
    for (const py::object& place : instances) scene.mesh.instances.push_back(to_mat4(place, "instances"));
    set_normals(scene.mesh, normals);
    scene.mesh.surface_uv = to_corner_uv(surface_uv, "surface_uv");
    scene.camera = to_camera(camera_matrix, resolution, projection, angle_x, ortho_width, shift);
    scene.lights = std::move(lights);
    scene.lut.mode = lut_mode(mode);
    scene.lut.axis = to_axis(base, size, max_thickness_mm);
    scene.lut.glow = glow_of(image, lut_u, glow_uv, !thickness_image.empty());
    scene.lut.image = std::move(image);
    if (!base.is_none() && scene.lut.mode == LutMode::paper) {
        scene.lut.base = gray_entries(base.cast<const BaseLut&>());
    }
    if (!base.is_none() && scene.lut.mode == LutMode::physical) {
        const auto& matrices = base.cast<const BaseLut&>().matrices();
        scene.lut.matrices.assign(matrices.begin(), matrices.end());
    }
    scene.lut.world_irradiance = numpy::to_vec3(world_irradiance, "world_irradiance");
    if (!thickness_image.empty()) {
        const glm::dvec2 range = to_vec2(thickness_range, "thickness_range");
        scene.lut.thickness = PovrayThicknessPicture{std::move(thickness_image), range.x, range.y};
    }
    const glm::dvec3 k = numpy::to_vec3(coefficients, "coefficients");
    scene.lut.coefficients = {k.x, k.y, k.z};
    scene.lut.blood_weight = numpy::to_vec3(blood_weight, "blood_weight");
    scene.lut.point = numpy::to_vec3(point, "point");
    scene.lut.strength = strength;
    if (!surface_color.is_none() || !surface_image.empty()) {
        scene.surface = PovraySurface{.color = glm::dvec3(1.0), .image = std::move(surface_image)};
        if (!surface_color.is_none()) scene.surface->color = numpy::to_vec3(surface_color, "surface_color");
    }
    if (frames) scene.frames = PovrayFrames{std::get<0>(*frames), std::get<1>(*frames), std::get<2>(*frames)};
    scene.background = numpy::to_vec3(background, "background");
    const py::gil_scoped_release release;
    return povray_files(scene);
}

}  // namespace

void bind_povray(py::module_& m) {
    m.def(
        "povray_frame_choice",
        [](const std::vector<std::pair<int, std::string>>& files) {
            std::vector<PovrayFrameFile> entries;
            for (const auto& [first_frame, file] : files) entries.push_back({first_frame, file});
            return povray_frame_choice(entries);
        },
        "files"_a,
        R"(The text of a file of an animated scene that includes one of `files`, [(first frame, name)], by the frame.)");
    m.def("povray_macros", &povray_macros,
          "The text of skinglow.inc, POV-Ray's macros, as `povray_files` writes it.");
    m.def(
        "povray_files", &povray_files_of_arrays, "vertices"_a, "triangles"_a, "lut_u"_a = py::none(),
        py::kw_only(), "camera_matrix"_a, "resolution"_a, "projection"_a = py::none(),
        "angle_x"_a = py::none(), "ortho_width"_a = py::none(), "shift"_a = py::make_tuple(0.0, 0.0),
        "mode"_a = "paper", "base"_a = py::none(), "size"_a = py::none(), "max_thickness_mm"_a = py::none(),
        "image"_a = "", "lights"_a = std::vector<Light>(), "point"_a = py::make_tuple(0.0, 0.0, 0.0),
        "coefficients"_a = py::make_tuple(1.0, 0.0, 1.0), "blood_weight"_a = py::make_tuple(1.8, 0.5, 0.4),
        "strength"_a = 1.0, "normals"_a = py::none(), "surface_color"_a = py::none(), "surface_image"_a = "",
        "surface_uv"_a = py::none(), "background"_a = py::make_tuple(0.0, 0.0, 0.0), "name"_a = "skin",
        "glow_uv"_a = py::none(), "world_irradiance"_a = py::make_tuple(0.0, 0.0, 0.0),
        "thickness_image"_a = "", "thickness_range"_a = py::make_tuple(0.0, 1.0), "frames"_a = py::none(),
        "instances"_a = std::vector<py::object>(),
        R"(The files of a POV-Ray 3.7 scene, {name: text}; only those that it uses. Write them all into one folder.

`povray scene.ini`, run in that folder, gives scene.exr (linear, half floats). World coordinates as Blender has them.

vertices, triangles  (n, 3) world space; (m, 3) indices. Unused vertices are left out
lut_u                (n,) image coordinate of each vertex in the lookup: with S entries over T mm of thickness d,
                     u = (d / T * (S - 1) + 0.5) / S; clamped to the first and last texel. Not with glow_uv
glow_uv              (m, 3, 2) in place of lut_u: coordinates of each triangle's corners in `image`, an EXR of any size
                     with the light at points of the skin; v up, (column + 0.5) / width at the center of a texel
camera_matrix        (4, 4) camera to world (it looks along -z); scale is ignored
resolution           (width, height), pixels
projection | angle_x | ortho_width   one of: (4, 4) as camera.calc_matrix_camera(depsgraph, x=width, y=height) gives
                     it; full angle of the width, radians; width in scene units (the latter two: square pixels, and
                     shift as a fraction of the longer side)
mode                 "existing", "paper" or "physical"
base | size, max_thickness_mm   the table's axis; by macros, mode "paper" needs base, a gray BaseLut, and mode
                     "physical" that of the skin
image                name of the lookup's EXR in the folder (POV-Ray reads it as half floats); "": the macros compute
                     the lookup from base and lights, in doubles
lights               [Light]; those that are off are left out
point, coefficients, blood_weight   of Eq. 1-3
strength             radiance shown = strength * lookup
normals              (n, 3) per vertex or (m, 3, 3) per corner, of any length; None: flat
surface_color | surface_image   matt surface under the glow, (3,) or a picture in the folder with surface_uv (m, 3, 2);
                     none: the glow alone. With a picture the scene is two renders, to be added:
                     `povray scene.ini Declare=Skinglow_Part=1` (surface) and `=2` (glow)
background           (3,) linear Rec.709
name                 of the object, any text
world_irradiance     (3,) mode "physical" by macros: added to that of the lights, W/m^2
thickness_image, thickness_range   by macros: thickness from an EXR or a 16-bit PNG or TIFF in the folder, in surface_uv;
                     mm where it is 0 and where it is 1. lut_u may be None then, and a surface_image takes one render
frames               None: a still; (first, last, frames per second): scene.ini renders these frames. The files are those of
                     one frame, see povray_frame_choice
instances            [(4, 4)] further places of the mesh: each moves the vertices to where they are once more
Raises ValueError naming what is wrong.)");
}
