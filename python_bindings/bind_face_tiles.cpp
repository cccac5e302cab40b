#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <skinglow/face_tiles.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mesh_arrays.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

/// (n,) whole numbers that 32 bits hold.
std::vector<std::uint32_t> to_indices(py::handle value, const char* name) {
    using Numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
    const py::array given = py::array::ensure(value);
    if (!given) {
        PyErr_Clear();
        refuse_argument(name, "not an array", "whole numbers of shape (n,)");
    }
    const char kind = given.dtype().kind();
    if (given.ndim() != 1 || (given.size() > 0 && kind != 'i' && kind != 'u')) {
        refuse_argument(
            name, "of shape " + numpy::shape_text(given) + " and type " + std::string(py::str(given.dtype())),
            "whole numbers of shape (n,)");
    }
    const Numbers numbers = Numbers::ensure(given);
    std::vector<std::uint32_t> result(static_cast<std::size_t>(numbers.size()));
    for (std::size_t i = 0; i < result.size(); ++i) {
        const std::int64_t number = numbers.data()[i];
        require(entry_name(name, i), number,
                number >= 0 && number <= std::numeric_limits<std::uint32_t>::max(),
                "a whole number, 0 or more");
        result[i] = static_cast<std::uint32_t>(number);
    }
    return result;
}

std::vector<std::uint8_t> to_flags(py::handle value, const char* name) {
    const numpy::Array given = numpy::to_array(value, name);
    if (given.ndim() != 1) refuse_argument(name, "of shape " + numpy::shape_text(given), "shape (v,)");
    std::vector<std::uint8_t> flags(static_cast<std::size_t>(given.size()));
    for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = given.data()[i] != 0 ? 1 : 0;
    return flags;
}

FaceTiles layout_of_arrays(py::handle vertices, py::handle face_sizes, py::handle corners, py::handle wanted,
                           double unit_mm, double spacing_mm, std::int64_t max_texels) {
    const std::vector<glm::dvec3> points = numpy::to_vec3s(vertices, "vertices");
    const std::vector<std::uint32_t> sizes = to_indices(face_sizes, "face_sizes");
    const std::vector<std::uint32_t> indices = to_indices(corners, "corners");
    std::vector<std::uint8_t> flags;
    if (!wanted.is_none()) {
        flags = to_flags(wanted, "wanted");
        require_count("wanted", flags.size(), points.size(), "one per vertex");
    }
    const std::size_t most = numpy::to_count(max_texels, "max_texels");
    return numpy::without_gil([&] {
        return FaceTiles(points, sizes, indices, flags, {unit_mm, spacing_mm, most});
    });
}

TileTargets targets_of_arrays(py::handle vertices, py::handle triangles, py::handle texels,
                              std::int64_t height, double unit_mm) {
    const std::size_t image_rows = numpy::to_count(height, "height");
    const TriangleMesh mesh = numpy::to_mesh(vertices, triangles);
    const numpy::FloatArray rows = numpy::to_floats(texels, "texels");
    if (rows.ndim() != 3 || rows.shape(1) != 3 || rows.shape(2) != 3)
        refuse_argument("texels", "of shape " + numpy::shape_text(rows), "shape (m, 3, 3)");
    const std::span of_corners(reinterpret_cast<const glm::vec3*>(rows.data()),
                               3 * static_cast<std::size_t>(rows.shape(0)));
    return numpy::without_gil([&] { return TileTargets(mesh, of_corners, image_rows, unit_mm); });
}

/// (n, columns), or (n,): one column.
std::size_t columns_of(const numpy::Array& values) {
    if (values.ndim() == 1) return 1;
    if (values.ndim() != 2)
        refuse_argument("values", "of shape " + numpy::shape_text(values), "shape (n, columns) or (n,)");
    return static_cast<std::size_t>(values.shape(1));
}

std::span<const double> numbers(const numpy::Array& values) {
    return {values.data(), static_cast<std::size_t>(values.size())};
}

py::array at_vertices(const TileTargets& self, py::handle values) {
    const numpy::Array given = numpy::to_array(values, "values");
    const std::size_t columns = columns_of(given);
    std::vector<double> found = numpy::without_gil([&] { return self.at_vertices(numbers(given), columns); });
    py::array result = numpy::from_doubles(std::move(found));
    return given.ndim() == 1 ? result : result.attr("reshape")(self.points().size(), columns);
}

py::array_t<float> spread(const TileTargets& self, py::handle values, const py::object& out) {
    const numpy::Array given = numpy::to_array(values, "values");
    const std::size_t columns = columns_of(given);
    const std::size_t height = self.of_texel().size() / tile_image_width;
    py::array_t<float> pixels;
    if (out.is_none()) {
        pixels = py::array_t<float>(std::vector<std::size_t>{height, tile_image_width, columns});
    } else {
        // The very array, or none of its memory is written.
        using FloatArray = py::array_t<float, py::array::c_style>;
        if (!py::isinstance<FloatArray>(out) || !out.cast<py::array>().writeable())
            refuse_argument("out", py::repr(py::type::of(out)).cast<std::string>(),
                            "a writable C-contiguous float32 array");
        pixels = out.cast<py::array_t<float>>();
    }
    if (pixels.ndim() != 3 || static_cast<std::size_t>(pixels.shape(0)) != height ||
        pixels.shape(1) != static_cast<py::ssize_t>(tile_image_width)) {
        refuse_argument(
            "out", "of shape " + numpy::shape_text(pixels),
            "shape (" + std::to_string(height) + ", " + std::to_string(tile_image_width) + ", channels)");
    }
    const std::span all(pixels.mutable_data(), static_cast<std::size_t>(pixels.size()));
    const auto channels = static_cast<std::size_t>(pixels.shape(2));
    numpy::without_gil([&] { self.spread(numbers(given), columns, channels, all); });
    return pixels;
}

/// A read-only (rows, columns) view of what `owner` keeps alive.
template <typename Number>
py::array view(const Number* data, std::size_t rows, std::size_t columns, py::handle owner) {
    py::array_t<Number> result(std::vector<std::size_t>{rows, columns}, data, owner);
    py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return result;
}

template <typename Row>
py::array view_of(const std::vector<Row>& rows, py::handle owner) {
    return view(reinterpret_cast<const typename Row::value_type*>(rows.data()), rows.size(), Row::length(),
                owner);
}

}  // namespace

void bind_face_tiles(py::module_& m) {
    const FaceTilesOptions defaults;
    py::class_<FaceTiles> layout(
        m, "FaceTiles",
        R"(Where in an image the faces of a mesh have their texels, for TileTargets and renderers. docs/face_tiles.md

vertices    (v, 3), finite
face_sizes  (f,), corners of each face, 3 or more
corners     (c,), vertex of each face corner, faces one after another
wanted      (v,): a face gets texels if one of its corners is wanted. None: all do
unit_mm     length of one unit of the vertices, mm, above 0
spacing_mm  of texels along edges, to the nearest whole number, above 0; faces whose edges are well below share a tile
max_texels  of the image, 1024 to 2^24; where it binds, the spacing grows
Raises ValueError naming the argument, the value and what is allowed.)");
    layout.attr("WIDTH") = tile_image_width;
    layout
        .def(py::init(&layout_of_arrays), "vertices"_a, "face_sizes"_a, "corners"_a, "wanted"_a = py::none(),
             py::kw_only(), "unit_mm"_a = defaults.unit_mm, "spacing_mm"_a = defaults.spacing_mm,
             "max_texels"_a = defaults.max_texels)
        .def_property_readonly(
            "texels", [](py::object self) { return view_of(self.cast<const FaceTiles&>().texels(), self); },
            "(c, 3) float32: x, y in texels, whose centers are whole numbers, and 1 + the index of the tile; "
            "zeros: no tile.")
        .def_property_readonly("width", [](const FaceTiles&) { return tile_image_width; })
        .def_property_readonly("height", &FaceTiles::height, "Rows of the image; 0 without tiles.")
        .def_property_readonly("tiles", &FaceTiles::tiles)
        .def_property_readonly("spacing_mm", &FaceTiles::spacing_mm,
                               "As asked for, or the larger one that max_texels allows.")
        .def("__repr__", [](const FaceTiles& self) {
            return "<skinglow.FaceTiles: " + std::to_string(self.tiles()) + " tiles, " +
                   std::to_string(tile_image_width) + " x " + std::to_string(self.height()) + " texels>";
        });
    py::class_<TileTargets>(m, "TileTargets",
                            R"(The points of a surface that the texels of its tiles stand for.

vertices   (v, 3), finite, of the mesh as it is shown: posed, subdivided
triangles  (m, 3), whole numbers from 0 to below v
texels     (m, 3, 3): FaceTiles.texels at the corners of each triangle, as a renderer interpolates them
height     rows of the image
unit_mm    length of one unit of the vertices, mm, above 0
Every texel that may be read for a point of a tile has a target; texels at one point of the surface share it.
Raises ValueError naming the argument, the value and what is allowed.)")
        .def(py::init(&targets_of_arrays), "vertices"_a, "triangles"_a, "texels"_a, "height"_a, py::kw_only(),
             "unit_mm"_a = 1.0)
        .def_property_readonly(
            "points", [](py::object self) { return view_of(self.cast<const TileTargets&>().points(), self); },
            "(k, 3), in the unit of the vertices.")
        .def_property_readonly(
            "normals",
            [](py::object self) { return view_of(self.cast<const TileTargets&>().normals(), self); },
            "(k, 3), unit length, outward by the triangles' winding; 0 where there is none.")
        .def_property_readonly(
            "of_texel",
            [](py::object self) {
                const auto& targets = self.cast<const TileTargets&>().of_texel();
                return view(targets.data(), targets.size() / tile_image_width, tile_image_width, self);
            },
            "(height, WIDTH) int32: the target of each texel; -1: none.")
        .def_property_readonly("overlapping", &TileTargets::overlapping,
                               "Fraction of the area of tiles in which a texel stands for two places of the "
                               "surface (mirrored, repeated).")
        .def_property_readonly("mixed", &TileTargets::mixed,
                               "Fraction of the area of tiles whose triangles reach from one tile into "
                               "another, or out of all (decimated).")
        .def_property_readonly("spacing_mm", &TileTargets::spacing_mm,
                               "Distance of texels on the surface as shown: root of its area for each.")
        .def(
            "at_vertices", &at_vertices, "values"_a,
            R"(Values at the targets, (k, n), from values at the vertices, (v, n) or (v,), linear on each triangle.

What is 0 or more at a triangle's corners stays so. Raises ValueError on what is not finite.)")
        .def(
            "spread", &spread, "values"_a, "out"_a = py::none(),
            R"(Pixels, (height, WIDTH, n) float32, from values at the targets, (k, n) or (k,). 0 where there is no target.

out  float32, C-contiguous, (height, WIDTH, n or more): written instead of a new array; further channels stay
Raises ValueError on what is not finite.)");
}
