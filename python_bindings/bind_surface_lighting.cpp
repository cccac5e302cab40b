#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/surface_lighting.h>

#include <array>
#include <vector>

#include "geometry/vector.h"
#include "numpy_conversion.h"
#include "rig/rig_data.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;
using skinglow::numpy::without_gil;

namespace {

SurfaceLighting make_lighting(py::handle lights, py::handle box_min, py::handle box_max,
                              const Environment* environment, const AngularWeight* angular_weight,
                              std::int64_t max_terms, double tolerance) {
    const PreparedRig rig = numpy::to_rig(lights);
    const Box box{numpy::to_vec3(box_min, "box_min"), numpy::to_vec3(box_max, "box_max")};
    const std::size_t terms = numpy::to_count(max_terms, "max_terms");
    return without_gil([&] {
        return SurfaceLighting(rig, box, {terms, tolerance, environment, angular_weight});
    });
}

/// (n, 4, 4): a row of texels for each term.
py::array terms_as_texels(const SurfaceLighting& self) {
    const auto count = static_cast<py::ssize_t>(self.terms().size());
    numpy::Array texels({count, py::ssize_t{4}, py::ssize_t{4}});
    double* out = texels.mutable_data();
    for (const SurfaceTerm& t : self.terms()) {
        const std::array<double, 16> row = {
            t.position.x,     t.position.y,     t.position.z,     t.is_positional,  //
            t.reverse_axis.x, t.reverse_axis.y, t.reverse_axis.z, t.radius_sq,      //
            t.strength.r,     t.strength.g,     t.strength.b,     t.smoothstep,     //
            t.cos_scale,      t.bias,           t.sin_scale,      t.cosine_falloff};
        out = std::copy(row.begin(), row.end(), out);
    }
    return texels;
}

py::array irradiance_shown(const SurfaceLighting& self, py::handle points, py::handle normals) {
    const std::vector<glm::dvec3> p = numpy::to_vec3s(points, "points");
    const std::vector<glm::dvec3> n = numpy::to_vec3s(normals, "normals");
    return numpy::from_vec3s(without_gil([&] {
        require_surface(p, n);
        std::vector<glm::dvec3> result(p.size());
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (n[i] != glm::dvec3(0.0)) result[i] = self.irradiance(p[i], unit(n[i]));
        }
        return result;
    }));
}

}  // namespace

void bind_surface_lighting(py::module_& m) {
    py::class_<SurfaceLighting>(
        m, "SurfaceLighting",
        R"(The light on the far side of a skin in a form that a material works out at each pixel.

A term for each light that matters (the brightest first), and one polynomial in the normal for the world and all lights
beyond max_terms, which shine as if from far away.
box_min, box_max  (3,), world: of the box that holds the skin
environment       Environment or None (black); angular_weight  AngularWeight or None (every angle alike)
max_terms         shader cost is linear in this
tolerance         an area light is cut into tiles until its terms are this near to its irradiance, as a fraction of all the
                  light, at the corners of the box; above 0
Raises ValueError naming what is wrong.)")
        .def(py::init(&make_lighting), "lights"_a, "box_min"_a, "box_max"_a, "environment"_a = py::none(),
             "angular_weight"_a = py::none(), "max_terms"_a = 8, "tolerance"_a = 0.01)
        .def_property_readonly("terms", &terms_as_texels,
                               R"((n, 4, 4): four texels for each term, plain terms first.

position (of a sun the unit direction to it) and is_positional, 1 (of a sun 0); reverse_axis (unit, against the direction
it shines to) and radius_sq; strength, W, linear Rec.709, and smoothstep; cos_scale, bias, sin_scale and cosine_falloff of
the profile. At a point x that faces along n:
v = position - is_positional x,  q = |v|^2 + radius_sq,  l = v/|v|,  s = sqrt(radius_sq/q),  mu = n.l,
h = clamp(mu + s, 0, 2s),  received = h^2/(4s) + max(mu - s, 0),  c = reverse_axis.l,
t = clamp(cos_scale c + bias + sin_scale sqrt(1 - c^2), 0, 1),
profile = t (1 + smoothstep (t(3 - 2t) - 1)) (1 + cosine_falloff (c - 1)),  E = strength w(mu) received profile / q.)")
        .def_property_readonly("plain_terms", &SurfaceLighting::plain_terms,
                               "How many terms have profile 1: they come first.")
        .def_property_readonly("lights_of_terms", &SurfaceLighting::lights_of_terms,
                               "Index of the light that each term is of.")
        .def_property_readonly("far_lights", &SurfaceLighting::far_lights,
                               "Indices of the lights that have no term: they are in the polynomial.")
        .def_property_readonly(
            "polynomial",
            [](const SurfaceLighting& self) {
                return numpy::from_vec3s({self.polynomial().begin(), self.polynomial().end()});
            },
            "(9, 3), W/m^2: coefficients of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2 of the normal. "
            "What is shown is the sum with the terms, not below 0.")
        .def_property_readonly(
            "angular",
            [](const SurfaceLighting& self) {
                return numpy::from_vec3s({self.angular().begin(), self.angular().end()});
            },
            "(4, 3): w(mu) = c0 + c1 mu + c2 mu^2 + c3 mu^3 of each channel, mu from 0 to 1.")
        .def("irradiance", &irradiance_shown, "points"_a, "normals"_a,
             "What the material shows: W/m^2, (n, 3), at points (n, 3) that face along normals (n, 3) of any "
             "length.");
    m.def(
        "normal_cone",
        [](py::handle normals) {
            const std::vector<glm::dvec3> directions = numpy::to_vec3s(normals, "normals");
            const NormalCone cone = without_gil([&] { return normal_cone(directions); });
            return py::make_tuple(numpy::from_vec3(cone.axis), cone.half_angle);
        },
        "normals"_a,
        "The cone that holds normals (n, 3) of any length: its unit axis (3,) and half angle, radians.");
}
