#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/occlusion.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bind_rays.h"
#include "mesh_arrays.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;

namespace skinglow {
namespace {

TriangleMesh to_mesh(py::handle value, const std::string& name) {
    const bool is_pair =
        py::isinstance<py::sequence>(value) && !py::isinstance<py::str>(value) && py::len(value) == 2;
    if (!is_pair) refuse_argument(name, py::repr(py::type::of(value)), "a pair (vertices, triangles)");
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    return numpy::to_mesh(py::object(pair[0]), py::object(pair[1]), name + " ");
}

std::unique_ptr<Occluders> make_occluders(const py::iterable& meshes, py::handle origin) {
    std::vector<TriangleMesh> owned;
    for (const py::handle mesh : meshes)
        owned.push_back(to_mesh(mesh, "meshes[" + std::to_string(owned.size()) + "]"));
    std::optional<glm::dvec3> about;
    if (!origin.is_none()) about = numpy::to_vec3(origin, "origin");
    const std::vector<MeshView> views(owned.begin(), owned.end());
    const py::gil_scoped_release unlocked;
    return std::make_unique<Occluders>(views, about);
}

py::tuple visible_fraction_of_arrays(const Occluders& self, const std::vector<Light>& lights,
                                     py::handle points, py::handle normals, int samples,
                                     std::vector<std::size_t> excluded, int threads) {
    const std::vector<glm::dvec3> positions = numpy::to_vec3s(points, "points");
    const std::vector<glm::dvec3> facing = numpy::to_vec3s(normals, "normals");
    VisibleFraction found;
    {
        const py::gil_scoped_release unlocked;
        found = visible_fraction(self, lights, positions, facing, {samples, std::move(excluded), threads});
    }
    py::array rows = numpy::from_doubles(std::move(found.at_points));
    rows = rows.attr("reshape")(positions.size(), lights.size());
    return py::make_tuple(numpy::from_doubles(std::move(found.mean)), rows);
}

}  // namespace

void bind_occlusion(py::module_& m) {
    m.attr("DEFAULT_SAMPLES") = VisibilityOptions{}.samples;
    py::class_<Occluders>(m, "Occluders", "See skinglow.Occluders.")
        .def(py::init(&make_occluders), "meshes"_a, "origin"_a)
        .def_property_readonly("triangles", &Occluders::triangles, "Triangles with area.")
        .def("__len__", &Occluders::meshes)
        .def("visible_fraction", &visible_fraction_of_arrays, "lights"_a, "points"_a, "normals"_a,
             "samples"_a, "excluded"_a, "threads"_a,
             "See skinglow.Occluders.visible_fraction: (mean, at_points).");
}

}  // namespace skinglow
