#include <pybind11/pybind11.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "argument_check.h"
#include "numpy_conversion.h"
#include "thickness.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

using IndexArray = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// (m, 3) whole numbers that 32 bits hold; the core checks them against the number of vertices.
std::vector<glm::uvec3> to_triangles(py::handle value, std::size_t vertices) {
    const py::array given = py::array::ensure(value);
    if (!given) {
        PyErr_Clear();
        refuse_argument("triangles", "not an array", "whole numbers of shape (m, 3)");
    }
    if (given.ndim() != 2 || given.shape(1) != 3) {
        refuse_argument("triangles", "of shape " + numpy::shape_text(given), "shape (m, 3)");
    }
    const char kind = given.dtype().kind();
    if (kind != 'i' && kind != 'u') {
        refuse_argument("triangles", "of type " + std::string(py::str(given.dtype())),
                        "whole numbers (an integer type)");
    }
    const IndexArray rows = IndexArray::ensure(given);
    std::vector<glm::uvec3> triangles(static_cast<std::size_t>(rows.shape(0)));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::int64_t* row = rows.data() + 3 * i;
        for (int k = 0; k < 3; ++k) {
            if (row[k] < 0 || row[k] > std::numeric_limits<std::uint32_t>::max()) {
                refuse_argument(
                    "triangles[" + std::to_string(i) + "]",
                    "(" + std::to_string(row[0]) + ", " + std::to_string(row[1]) + ", " +
                        std::to_string(row[2]) + ")",
                    "indices from 0 to below " + std::to_string(vertices) + ", the number of vertices");
            }
            triangles[i][k] = static_cast<std::uint32_t>(row[k]);
        }
    }
    return triangles;
}

/// Asks Python whether to go on: an interrupt from the keyboard counts, with and without a function of the
/// caller's. Called without the interpreter's lock, which the work itself does not need.
ThicknessProgress ask_python(const py::object& progress) {
    return [&progress](double done) {
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (progress.is_none()) return true;
        const int go_on = PyObject_IsTrue(progress(done).ptr());
        if (go_on < 0) throw py::error_already_set();
        return go_on != 0;
    };
}

py::array thickness_of_arrays(py::handle vertices, py::handle triangles, double unit_mm, int rays,
                              double cone_half_angle, double min_openness, int threads,
                              const py::object& progress) {
    const std::vector<glm::dvec3> points = numpy::to_vec3s(vertices, "vertices");
    const std::vector<glm::uvec3> corners = to_triangles(triangles, points.size());
    const ThicknessOptions options{unit_mm, rays, cone_half_angle, min_openness, threads};
    std::vector<double> values;
    {
        const py::gil_scoped_release unlocked;
        values = thickness(points, corners, options, ask_python(progress));
    }
    return numpy::from_doubles(std::move(values));
}

}  // namespace

PYBIND11_MODULE(_rays, m) {
    m.doc() = "Thickness of a mesh, by rays (Embree). Import it through skinglow.thickness.";
    py::register_exception<ThicknessCancelled>(m, "ThicknessCancelled", PyExc_RuntimeError);
    m.attr("DEFAULT_RAYS") = ThicknessOptions{}.rays;
    m.attr("DEFAULT_CONE_HALF_ANGLE") = ThicknessOptions{}.cone_half_angle;
    m.def("thickness", &thickness_of_arrays, "vertices"_a, "triangles"_a, "unit_mm"_a, "rays"_a,
          "cone_half_angle"_a, "min_openness"_a, "threads"_a, "progress"_a, "See skinglow.thickness.");
}
