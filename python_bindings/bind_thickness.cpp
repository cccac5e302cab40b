#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <skinglow/thickness.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "bind_rays.h"
#include "mesh_arrays.h"
#include "numpy_conversion.h"
#include "progress.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

py::tuple report_of_arrays(py::handle vertices, py::handle triangles, double unit_mm, int rays,
                           double cone_half_angle, double min_sky_visibility, int threads,
                           const py::object& progress) {
    const TriangleMesh mesh = numpy::to_mesh(vertices, triangles);
    const ThicknessOptions options{unit_mm, rays, cone_half_angle, min_sky_visibility, threads};
    ThicknessReport report;
    {
        const py::gil_scoped_release unlocked;
        report = thickness_report(mesh, options, ask_python(progress));
    }
    py::array_t<bool> no_far_side(static_cast<py::ssize_t>(report.no_far_side.size()));
    std::copy(report.no_far_side.begin(), report.no_far_side.end(), no_far_side.mutable_data());
    return py::make_tuple(numpy::from_doubles(std::move(report.mm)), no_far_side);
}

}  // namespace

namespace skinglow {

void bind_thickness(py::module_& m) {
    py::register_local_exception<ThicknessCancelled>(m, "ThicknessCancelled", PyExc_RuntimeError);
    m.attr("DEFAULT_RAYS") = ThicknessOptions{}.rays;
    m.attr("DEFAULT_CONE_HALF_ANGLE") = ThicknessOptions{}.cone_half_angle;
    m.def("thickness_report", &report_of_arrays, "vertices"_a, "triangles"_a, "unit_mm"_a, "rays"_a,
          "cone_half_angle"_a, "min_sky_visibility"_a, "threads"_a, "progress"_a,
          "See skinglow.thickness_report.");
}

}  // namespace skinglow
