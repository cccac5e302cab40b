#include <pybind11/pybind11.h>

#include <numbers>
#include <string>
#include <utility>

#include "light/light.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

Light make_light(std::string_view kind, py::handle color, py::handle position, py::handle direction,
                 double power, std::string name, bool visible, double radius, bool soft_falloff,
                 double sun_angle, double spot_angle, double spot_blend, bool spot_cosine,
                 std::string_view shape, double size_x, double size_y, py::handle tangent, double spread) {
    Light light;
    light.kind = light_kind(kind);
    light.color = numpy::to_vec3(color, "color");
    light.position = numpy::to_vec3(position, "position");
    light.direction = numpy::to_vec3(direction, "direction");
    light.power = power;
    light.name = std::move(name);
    light.visible = visible;
    light.radius = radius;
    light.soft_falloff = soft_falloff;
    light.sun_angle = sun_angle;
    light.spot_angle = spot_angle;
    light.spot_blend = spot_blend;
    light.spot_cosine = spot_cosine;
    light.area_shape = area_shape(shape);
    light.size_x = size_x;
    light.size_y = size_y;
    light.tangent = numpy::to_vec3(tangent, "tangent");
    light.spread = spread;
    validate(light);
    return light;
}

}  // namespace

void bind_light(py::module_& m) {
    py::class_<Light>(m, "Light", R"(A lamp as a scene has it; it does not change once made.

kind       "POINT", "SUN", "SPOT" or "AREA"
color      (3,) linear Rec.709, each 0 or more
position   (3,) world, in the scene's length unit; a sun has none that matters
direction  (3,) where it shines to; any length but 0 for SUN, SPOT and AREA
power      W; for a SUN W/m^2. Mode `paper` asks only whether it is 0
name       for reports
visible    False: off, left out of every sum

What has an extent, for irradiance (mode `paper` does not look at it); lengths in the scene's unit, angles in radians:
radius        POINT and SPOT: of the glowing ball, 0 or more
soft_falloff  POINT and SPOT: True, a disk that always faces the lit point (as Blender by default); False, a ball
sun_angle     SUN: full angle it is seen under, 0 to pi
spot_angle    SPOT: full angle of the cone, 0 (no light) to pi
spot_blend    SPOT: share of the cone that fades, 0 to 1
spot_cosine   SPOT: also times the cosine to its axis (Blender 3.4 does this, 4.5 and later do not)
area_shape    AREA: "RECTANGLE" ("SQUARE") or "ELLIPSE" ("DISK")
size_x, size_y, tangent  AREA: full widths along and across tangent, a world direction; both widths 0: a small lamp
spread        AREA: full angle it shines into, 0 (no light) to pi (Lambert emitter)
Raises ValueError naming light, field, value and what is allowed.)")
        .def(py::init(&make_light), "kind"_a = "POINT", "color"_a = py::make_tuple(1.0, 1.0, 1.0),
             "position"_a = py::make_tuple(0.0, 0.0, 0.0), "direction"_a = py::make_tuple(0.0, 0.0, -1.0),
             "power"_a = 1.0, "name"_a = "", "visible"_a = true, py::kw_only(), "radius"_a = 0.0,
             "soft_falloff"_a = true, "sun_angle"_a = 0.0, "spot_angle"_a = std::numbers::pi / 4,
             "spot_blend"_a = 0.15, "spot_cosine"_a = false, "area_shape"_a = "RECTANGLE", "size_x"_a = 0.0,
             "size_y"_a = 0.0, "tangent"_a = py::make_tuple(1.0, 0.0, 0.0), "spread"_a = std::numbers::pi)
        .def_property_readonly("kind", [](const Light& self) { return to_text(self.kind); })
        .def_property_readonly("color", [](const Light& self) { return numpy::from_vec3(self.color); })
        .def_property_readonly("position", [](const Light& self) { return numpy::from_vec3(self.position); })
        .def_property_readonly("direction",
                               [](const Light& self) { return numpy::from_vec3(self.direction); })
        .def_readonly("power", &Light::power)
        .def_readonly("name", &Light::name)
        .def_readonly("visible", &Light::visible)
        .def_readonly("radius", &Light::radius)
        .def_readonly("soft_falloff", &Light::soft_falloff)
        .def_readonly("sun_angle", &Light::sun_angle)
        .def_readonly("spot_angle", &Light::spot_angle)
        .def_readonly("spot_blend", &Light::spot_blend)
        .def_readonly("spot_cosine", &Light::spot_cosine)
        .def_property_readonly("area_shape", [](const Light& self) { return to_text(self.area_shape); })
        .def_readonly("size_x", &Light::size_x)
        .def_readonly("size_y", &Light::size_y)
        .def_property_readonly("tangent", [](const Light& self) { return numpy::from_vec3(self.tangent); })
        .def_readonly("spread", &Light::spread)
        .def_property_readonly(
            "is_on", [](const Light& self) { return is_on(self); },
            "False for a lamp that gives nothing: hidden, power 0 or black.")
        .def("__repr__", [](const Light& self) {
            return "<skinglow.Light \"" + self.name + "\" " + std::string(to_text(self.kind)) + ", color " +
                   to_text(self.color) + ", power " + to_text(self.power) +
                   (self.visible ? ">" : ", hidden>");
        });
}
