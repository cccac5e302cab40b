#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/angular_weight.h>
#include <skinglow/environment.h>
#include <skinglow/light.h>
#include <skinglow/rig.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;
using skinglow::numpy::without_gil;

namespace {

void bind_object_weights(py::module_& m) {
    m.def(
        "object_irradiance_by_light",
        [](py::handle lights, py::handle point, double tolerance) {
            const PreparedRig rig = numpy::to_rig(lights);
            const glm::dvec3 at = numpy::to_vec3(point, "point");
            return numpy::from_vec3s(
                without_gil([&] { return object_irradiance_by_light(rig, at, tolerance); }));
        },
        "lights"_a, "point"_a, "tolerance"_a = default_area_tolerance,
        R"(What each light brings to a point on a surface that faces it, shape (n, 3), W/m^2, linear Rec.709.

Units are Blender's, a unit of length is a meter: a point light of P watts gives P / (4 pi d^2), a spot the same times
its cone, a sun P, an area light the irradiance of its shape at radiance P / (pi A). Lights that are off give zeros,
negative power takes light away. No light is nearer than 1e-6.
lights     sequence of Light, or a PreparedRig
point      (3,), world
tolerance  relative, of the integrals for elliptic lights, above 0. Raises ValueError naming what is wrong.)");
    m.def(
        "object_irradiance",
        [](py::handle lights, py::handle point, double tolerance) {
            const PreparedRig rig = numpy::to_rig(lights);
            const glm::dvec3 at = numpy::to_vec3(point, "point");
            return numpy::from_vec3(without_gil([&] { return object_irradiance(rig, at, tolerance); }));
        },
        "lights"_a, "point"_a, "tolerance"_a = default_area_tolerance,
        R"(The sum of object_irradiance_by_light, shape (3,): E of mode `physical` for a whole object; zeros without lights.

The order of the lights does not matter beyond the last bits: the sum is compensated.)");
}

using Vec3s = std::span<const glm::dvec3>;

/// (n, 3) doubles as the core's vectors, without a copy.
Vec3s view_of_vec3s(const numpy::Array& array, std::string_view name) {
    if (array.ndim() != 2 || array.shape(1) != 3) {
        refuse_argument(name, "of shape " + numpy::shape_text(array), "shape (n, 3)");
    }
    return {reinterpret_cast<const glm::dvec3*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

std::span<const double> view_of_doubles(const numpy::Array& array, std::string_view name) {
    if (array.ndim() > 1)
        refuse_argument(name, "of shape " + numpy::shape_text(array), "a number or shape (n,)");
    return {array.data(), static_cast<std::size_t>(array.size())};
}

AngularWeight make_angular_weight(py::handle mu, py::handle transmittance) {
    const numpy::Array cosines = numpy::to_array(mu, "mu");
    const numpy::Array values = numpy::to_array(transmittance, "transmittance");
    const std::span<const double> cos_angles = view_of_doubles(cosines, "mu");
    if (values.ndim() == 2) {
        const Vec3s rows = view_of_vec3s(values, "transmittance");
        return without_gil([&] { return AngularWeight(cos_angles, rows); });
    }
    const std::span<const double> gray = view_of_doubles(values, "transmittance");
    return without_gil([&] { return AngularWeight(cos_angles, gray); });
}

py::array angular_weight_at(const AngularWeight& self, py::handle mu) {
    const numpy::Array cosines = numpy::to_array(mu, "mu");
    const std::span<const double> values = view_of_doubles(cosines, "mu");
    return numpy::from_vec3s(without_gil([&] {
        std::vector<glm::dvec3> weights;
        weights.reserve(values.size());
        for (const double x : values) weights.push_back(self.at(require_finite("mu", x)));
        return weights;
    }));
}

void bind_angular_weight(py::module_& m) {
    py::class_<AngularWeight>(m, "AngularWeight",
                              R"(How much more light from one angle comes through than light from everywhere.

w(mu) = T(mu) / (2 integral of T(mu) mu dmu), mu the cosine to the normal: diffuse light counts once, by definition.
mu             (n,) ascending, 0 to 1
transmittance  (n,) or (n, 3) for R, G, B, 0 or more, as slab(...) gives it; a common factor drops out
Raises ValueError naming the entry.)")
        .def(py::init(&make_angular_weight), "mu"_a, "transmittance"_a)
        .def("at", &angular_weight_at, "mu"_a, "w at cosines (n,) or one, clamped to 0 to 1; shape (n, 3).");
}

void bind_surface_weights(py::module_& m) {
    m.def(
        "surface_irradiance",
        [](py::handle lights, py::handle points, py::handle normals, const AngularWeight* angular_weight,
           const Environment* environment, double tolerance, int threads) {
            const PreparedRig rig = numpy::to_rig(lights);
            const numpy::Array point_array = numpy::to_array(points, "points");
            const numpy::Array normal_array = numpy::to_array(normals, "normals");
            const Vec3s p = view_of_vec3s(point_array, "points");
            const Vec3s n = view_of_vec3s(normal_array, "normals");
            return numpy::from_vec3s(without_gil([&] {
                return surface_irradiance(rig, p, n, {tolerance, angular_weight, environment, threads});
            }));
        },
        "lights"_a, "points"_a, "normals"_a, py::kw_only(), "angular_weight"_a = py::none(),
        "environment"_a = py::none(), "tolerance"_a = default_area_tolerance, "threads"_a = 0,
        R"(Irradiance at points that each face along a normal, with cosine and horizon, (n, 3), W/m^2, linear Rec.709.

lights           sequence of Light, or a PreparedRig
points, normals  (n, 3), finite; normals of any length, (0, 0, 0) receives nothing
tolerance        relative, of the integrals for elliptic lights and spreads
threads          0: one for each processor. Raises ValueError naming the entry.)");
    m.def(
        "far_side",
        [](py::handle vertices, py::handle normals, py::handle depth) {
            const numpy::Array vertex_array = numpy::to_array(vertices, "vertices");
            const numpy::Array normal_array = numpy::to_array(normals, "normals");
            const numpy::Array depths = numpy::to_array(depth, "depth");
            const Vec3s p = view_of_vec3s(vertex_array, "vertices");
            const Vec3s n = view_of_vec3s(normal_array, "normals");
            const std::span<const double> d = view_of_doubles(depths, "depth");
            SurfacePoints far = without_gil([&] { return far_side(p, n, d); });
            return py::make_tuple(numpy::from_vec3s(std::move(far.points)),
                                  numpy::from_vec3s(std::move(far.normals)));
        },
        "vertices"_a, "normals"_a, "depth"_a,
        R"(The far side of skin: (points, normals), each (n, 3): x - d n, facing along -n, of length 1.

vertices, normals  (n, 3), finite; a normal of (0, 0, 0) stays, and its point is the vertex
depth              d, (n,) or one for all, in the vertices' unit, 0 or more. Raises ValueError naming the entry.)");
    m.def(
        "far_side_irradiance",
        [](py::handle lights, py::handle vertices, py::handle normals, py::handle depth,
           const AngularWeight* angular_weight, const Environment* environment, double tolerance,
           int threads) {
            const PreparedRig rig = numpy::to_rig(lights);
            const numpy::Array vertex_array = numpy::to_array(vertices, "vertices");
            const numpy::Array normal_array = numpy::to_array(normals, "normals");
            const numpy::Array depths = numpy::to_array(depth, "depth");
            const Vec3s p = view_of_vec3s(vertex_array, "vertices");
            const Vec3s n = view_of_vec3s(normal_array, "normals");
            const std::span<const double> d = view_of_doubles(depths, "depth");
            return numpy::from_vec3s(without_gil([&] {
                return far_side_irradiance(rig, p, n, d, {tolerance, angular_weight, environment, threads});
            }));
        },
        "lights"_a, "vertices"_a, "normals"_a, "depth"_a, py::kw_only(), "angular_weight"_a = py::none(),
        "environment"_a = py::none(), "tolerance"_a = default_area_tolerance, "threads"_a = 0,
        R"(surface_irradiance on the far side of skin: at vertex - depth * normal, facing along -normal; shape (n, 3).

depth  a number or (n,), in the scene's length unit (not mm), 0 or more)");
}

void bind_units(py::module_& m) {
    m.def("exposure_factor", &exposure_factor, "stops"_a,
          "2^stops: the factor on a light's power for its exposure.");
    m.def("unnormalized_power_factor", &unnormalized_power_factor, "light"_a,
          "The factor on the power of a light whose `normalize` is off: the area of what glows, scene unit "
          "squared\n"
          "(area light: its area; point and spot: 4 pi r^2; sun: pi sin^2(angle / 2)).");
    m.def(
        "black_body_color", [](double kelvin) { return numpy::from_vec3(black_body_color(kelvin)); },
        "kelvin"_a,
        "Color of a black body, (3,) linear Rec.709 of luminance 1, none below 0; 800 to 20000 K.");
    m.attr("LEGACY_AREA_POWER_FACTOR") = legacy_area_power_factor;
    m.def("legacy_sun_power_factor", &legacy_sun_power_factor, "angle"_a,
          "2 c / (1 + c), c = cos(angle / 2): the factor on the power of a sun in Blender 3.4; angle in "
          "radians.");
}

}  // namespace

void bind_environment(py::module_& m);
void bind_light_choice(py::module_& m);

void bind_irradiance(py::module_& m) {
    bind_angular_weight(m);
    bind_environment(m);
    bind_object_weights(m);
    bind_surface_weights(m);
    bind_units(m);
    bind_light_choice(m);
}
