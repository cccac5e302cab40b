#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bind_rays.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"
#include "rays/visibility.h"
#include "triangle_arrays.h"

namespace py = pybind11;
using namespace py::literals;

namespace skinglow {
namespace {

struct OwnedMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
};

OwnedMesh to_mesh(py::handle value, const std::string& name) {
    const bool is_pair =
        py::isinstance<py::sequence>(value) && !py::isinstance<py::str>(value) && py::len(value) == 2;
    if (!is_pair) refuse_argument(name, py::repr(py::type::of(value)), "a pair (vertices, triangles)");
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    OwnedMesh mesh;
    mesh.vertices = numpy::to_vec3s(py::object(pair[0]), name + " vertices");
    mesh.triangles = numpy::to_triangles(py::object(pair[1]), name + " triangles", mesh.vertices.size());
    return mesh;
}

std::unique_ptr<Occluders> make_occluders(const py::iterable& meshes, py::handle origin) {
    std::vector<OwnedMesh> owned;
    for (const py::handle mesh : meshes)
        owned.push_back(to_mesh(mesh, "meshes[" + std::to_string(owned.size()) + "]"));
    std::optional<glm::dvec3> about;
    if (!origin.is_none()) about = numpy::to_vec3(origin, "origin");
    std::vector<MeshView> views;
    for (const OwnedMesh& mesh : owned) views.push_back({mesh.vertices, mesh.triangles});
    const py::gil_scoped_release unlocked;
    return std::make_unique<Occluders>(views, about);
}

py::tuple visible_share_of_arrays(const Occluders& self, const std::vector<Light>& lights, py::handle points,
                                  py::handle normals, int samples, std::vector<std::size_t> without,
                                  int threads) {
    const std::vector<glm::dvec3> places = numpy::to_vec3s(points, "points");
    const std::vector<glm::dvec3> facing = numpy::to_vec3s(normals, "normals");
    VisibleShare found;
    {
        const py::gil_scoped_release unlocked;
        found = visible_share(self, lights, places, facing, {samples, std::move(without), threads});
    }
    py::array rows = numpy::from_doubles(std::move(found.at_points));
    rows = rows.attr("reshape")(places.size(), lights.size());
    return py::make_tuple(numpy::from_doubles(std::move(found.mean)), rows);
}

}  // namespace

void bind_occlusion(py::module_& m) {
    m.attr("DEFAULT_SAMPLES") = VisibilityOptions{}.samples;
    py::class_<Occluders>(m, "Occluders", "See skinglow.Occluders.")
        .def(py::init(&make_occluders), "meshes"_a, "origin"_a)
        .def_property_readonly("triangles", &Occluders::triangles, "Triangles with area.")
        .def("__len__", &Occluders::meshes)
        .def("visible_share", &visible_share_of_arrays, "lights"_a, "points"_a, "normals"_a, "samples"_a,
             "without"_a, "threads"_a, "See skinglow.Occluders.visible_share: (mean, at_points).");
}

}  // namespace skinglow
