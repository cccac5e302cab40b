#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/shape.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bind_rays.h"
#include "mesh_arrays.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"
#include "progress.h"

namespace py = pybind11;
using namespace py::literals;

namespace skinglow {
namespace {

/// Three numbers, or one for all three channels.
glm::dvec3 to_channels(py::handle value, const char* name) {
    const numpy::Array array = numpy::to_array(value, name);
    if (array.ndim() == 0) return glm::dvec3(*array.data());
    return numpy::to_vec3(value, name);
}

/// A skinglow.Tissue, whose type is the other module's own; None is the skin that a Tissue is by default.
Tissue to_tissue(py::handle value) {
    Tissue tissue;
    if (value.is_none()) return tissue;
    if (!py::isinstance(value, py::module_::import("skinglow._core").attr("Tissue")))
        refuse_argument("tissue", py::repr(value).cast<std::string>(), "a skinglow.Tissue or None");
    for (const TissueParameter& parameter : tissue_parameters())
        tissue.*parameter.field = value.attr(py::str(std::string(parameter.name))).cast<double>();
    return tissue;
}

/// The medium: coefficients, or the tissue, or the skin that a Tissue is by default.
Shape make_shape(py::handle vertices, py::handle triangles, py::handle tissue, py::handle absorption,
                 py::handle reduced_scattering, double refractive_index, const std::string& surface,
                 double unit_mm, double cell_mm, double max_thickness_mm, py::handle points,
                 py::handle normals, int threads, const py::object& progress, double tolerance) {
    const TriangleMesh mesh = numpy::to_mesh(vertices, triangles);
    const ShapeOptions options{unit_mm, cell_mm,  max_thickness_mm, surface_finish(surface),
                               threads, tolerance};
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> facing;
    ShapePoints where;
    if (!points.is_none()) where.points = positions = numpy::to_vec3s(points, "points");
    if (!normals.is_none()) {
        if (points.is_none()) refuse_argument("normals", "given without points", "normals only with points");
        where.normals = facing = numpy::to_vec3s(normals, "normals");
        // To the core none are a direction for each.
        require_count("normals", facing.size(), positions.size(), "one per point");
    }
    const bool has_medium = !absorption.is_none() || !reduced_scattering.is_none();
    if (!has_medium) {
        const Tissue skin = to_tissue(tissue);
        return numpy::without_gil([&] { return Shape(mesh, skin, options, where, ask_python(progress)); });
    }
    if (!tissue.is_none())
        refuse_argument("tissue", "given with coefficients", "a tissue or coefficients, not both");
    if (absorption.is_none() || reduced_scattering.is_none()) {
        refuse_argument(absorption.is_none() ? "absorption" : "reduced_scattering", "not given",
                        "three numbers each, 1/mm: absorption and reduced_scattering go together");
    }
    const ShapeMedium medium{to_channels(absorption, "absorption"),
                             to_channels(reduced_scattering, "reduced_scattering"), refractive_index};
    return numpy::without_gil([&] { return Shape(mesh, medium, options, where, ask_python(progress)); });
}

/// (v, 3), or (v,): the same for all channels.
std::vector<glm::dvec3> to_irradiance(py::handle value) {
    const numpy::Array array = numpy::to_array(value, "irradiance");
    if (array.ndim() != 1) return numpy::to_vec3s(value, "irradiance");
    const double* data = array.data();
    std::vector<glm::dvec3> result(static_cast<std::size_t>(array.shape(0)));
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = glm::dvec3(data[i]);
    return result;
}

py::array exitance_of_array(const Shape& self, py::handle irradiance, const py::object& progress) {
    const std::vector<glm::dvec3> given = to_irradiance(irradiance);
    return numpy::from_vec3s(numpy::without_gil([&] { return self.exitance(given, ask_python(progress)); }));
}

py::array exitance_error_array(const Shape& self, py::handle irradiance, const py::object& progress) {
    const std::vector<glm::dvec3> given = to_irradiance(irradiance);
    return numpy::from_vec3s(
        numpy::without_gil([&] { return self.exitance_error(given, ask_python(progress)); }));
}

LitShape lit_by_arrays(const Shape& self, py::handle lights, const std::optional<Environment>& environment,
                       const std::optional<Occluders>& occluders, std::vector<std::size_t> excluded,
                       std::vector<std::size_t> shadowless, int reentries, int shadow_samples,
                       double solver_tolerance, const std::optional<LitShape>& previous,
                       py::handle occluder_frame, const py::object& progress) {
    const PreparedRig rig = numpy::to_rig(lights);
    const ShapeLightOptions options{
        environment ? &*environment : nullptr,
        occluders ? &*occluders : nullptr,
        std::move(excluded),
        std::move(shadowless),
        reentries,
        shadow_samples,
        solver_tolerance,
        previous ? &*previous : nullptr,
        occluder_frame.is_none() ? glm::dmat4(1.0) : numpy::to_matrix4(occluder_frame, "occluder_frame")};
    return numpy::without_gil([&] { return self.light(rig, options, ask_python(progress)); });
}

py::array per_light_array(const LitShape& self) {
    const py::object no_function = py::none();
    py::array rows =
        numpy::from_vec3s(numpy::without_gil([&] { return self.per_light(ask_python(no_function)); }));
    return rows.attr("reshape")(self.lights(), self.exitance().size(), 3);
}

py::array recolored(const LitShape& self, py::handle colors, bool transmitted, const py::object& progress) {
    const std::vector<glm::dvec3> given = numpy::to_vec3s(colors, "colors");
    return numpy::from_vec3s(numpy::without_gil([&] {
        const ShapeProgress told = ask_python(progress);
        return transmitted ? self.recolor_transmitted(given, told) : self.recolor(given, told);
    }));
}

template <typename Of>
Of in_tissue(const Of& self, py::handle tissue) {
    const Tissue skin = to_tissue(tissue);
    return numpy::without_gil([&] { return self.with_tissue(skin); });
}

py::array copy_of(const std::vector<glm::dvec3>& rows) {
    return numpy::from_vec3s(std::vector<glm::dvec3>(rows));
}

py::dict part_of(const ShapePart& part) {
    py::array_t<std::int64_t> points(static_cast<py::ssize_t>(part.points.size()));
    std::copy(part.points.begin(), part.points.end(), points.mutable_data());
    return py::dict("center"_a = numpy::from_vec3(part.center), "points"_a = points,
                    "is_ready"_a = part.is_ready, "cell_mm"_a = part.cell_mm, "cells"_a = part.cells,
                    "bytes"_a = part.bytes, "lost_area_fraction"_a = part.lost_area_fraction);
}

}  // namespace

void bind_shape(py::module_& m) {
    py::register_local_exception<ShapeCancelled>(m, "ShapeCancelled", PyExc_RuntimeError);
    py::class_<LitShape>(m, "LitShape", "See skinglow.LitShape.")
        .def_property_readonly("exitance", [](const LitShape& self) { return copy_of(self.exitance()); })
        .def_property_readonly("transmitted",
                               [](const LitShape& self) { return copy_of(self.transmitted()); })
        .def_property_readonly("irradiance", [](const LitShape& self) { return copy_of(self.irradiance()); })
        .def("mean_error",
             [](const LitShape& self) {
                 LitShape::MeanError found = numpy::without_gil([&] { return self.mean_error(); });
                 return py::make_tuple(numpy::from_vec3(found.of_all),
                                       numpy::from_vec3s(std::move(found.of_parts)));
             })
        .def("error",
             [](const LitShape& self) {
                 return numpy::from_vec3s(numpy::without_gil([&] { return self.error(); }));
             })
        .def_property_readonly("left_out", &LitShape::left_out)
        .def("per_light", &per_light_array, "See skinglow.LitShape.per_light.")
        .def("recolor", &recolored, "colors"_a, "transmitted"_a, "progress"_a,
             "See skinglow.LitShape.recolor.")
        .def("with_tissue", &in_tissue<LitShape>, "tissue"_a, "See skinglow.LitShape.with_tissue.");
    py::class_<Shape>(m, "Shape", "See skinglow.Shape.")
        .def(py::init(&make_shape), "vertices"_a, "triangles"_a, "tissue"_a, "absorption"_a,
             "reduced_scattering"_a, "refractive_index"_a, "surface"_a, "unit_mm"_a, "cell_mm"_a,
             "max_thickness_mm"_a, "points"_a, "normals"_a, "threads"_a, "progress"_a, "tolerance"_a)
        .def_property_readonly("points",
                               [](const Shape& self) {
                                   std::vector<glm::dvec3> mm = self.points();
                                   for (glm::dvec3& p : mm) p *= self.options().unit_mm;
                                   return numpy::from_vec3s(std::move(mm));
                               })
        .def_property_readonly("cell_mm", [](const Shape& self) { return self.options().cell_mm; })
        .def_property_readonly("bytes", &Shape::bytes)
        .def_property_readonly("enclosed_fraction", &Shape::enclosed_fraction)
        .def("parts",
             [](const Shape& self) {
                 py::list list;
                 for (const ShapePart& part : self.parts()) list.append(part_of(part));
                 return list;
             })
        .def("exitance", &exitance_of_array, "irradiance"_a, "progress"_a, "See skinglow.Shape.exitance.")
        .def("exitance_error", &exitance_error_array, "irradiance"_a, "progress"_a,
             "See skinglow.Shape.exitance_error.")
        .def("light", &lit_by_arrays, "lights"_a, "environment"_a, "occluders"_a, "excluded"_a,
             "shadowless"_a, "reentries"_a, "shadow_samples"_a, "solver_tolerance"_a, "previous"_a,
             "occluder_frame"_a, "progress"_a, "See skinglow.Shape.light.")
        .def("with_tissue", &in_tissue<Shape>, "tissue"_a, "See skinglow.Shape.with_tissue.");
}

}  // namespace skinglow
