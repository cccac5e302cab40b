#include <pybind11/pybind11.h>
#include <skinglow/light.h>

#include <numbers>
#include <string>
#include <utility>

#include "light/light_fields.h"
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
    // Keywords that the kind does not have are taken and mean nothing.
    const AreaLight area{area_shape(shape), size_x, size_y, numpy::to_vec3(tangent, "tangent"), spread};
    LightSettings light;
    switch (light_kind(kind)) {
        case LightKind::point:
            light.shape = PointLight{radius, soft_falloff};
            break;
        case LightKind::sun:
            light.shape = SunLight{sun_angle};
            break;
        case LightKind::spot:
            light.shape = SpotLight{radius, soft_falloff, spot_angle, spot_blend, spot_cosine};
            break;
        case LightKind::area:
            light.shape = area;
            break;
    }
    light.color = numpy::to_vec3(color, "color");
    light.position = numpy::to_vec3(position, "position");
    light.direction = numpy::to_vec3(direction, "direction");
    light.power = power;
    light.name = std::move(name);
    light.visible = visible;
    return light;
}

py::object to_python(const glm::dvec3& value) {
    return numpy::from_vec3(value);
}
py::object to_python(AreaShape value) {
    return py::cast(to_text(value));
}
template <typename Value>
py::object to_python(const Value& value) {
    return py::cast(value);
}

using LightClass = py::class_<Light>;

/// An attribute for each field of a shape; of another kind's light it is the default.
template <typename Shape>
void def_shape_fields(LightClass& light) {
    constexpr Shape usual{};
    for_each_field_of(usual, [&](const auto& field, const auto& /*owner*/) {
        light.def_property_readonly(std::string(field.key).c_str(), [key = field.key](const Light& self) {
            py::object found;
            const Shape usual_shape{};
            for_each_field_of(usual_shape, [&](const auto& f, const auto& owner) {
                if (f.key == key) found = to_python(owner.*f.member);
            });
            for_each_field(self.settings(), [&](const auto& f, const auto& owner) {
                if (f.key == key) found = to_python(owner.*f.member);
            });
            return found;
        });
    });
}

}  // namespace

void bind_light(py::module_& m) {
    LightClass light(m, "Light", R"(A light as a scene has it; it does not change once made.

kind       "POINT", "SUN", "SPOT" or "AREA"
color      (3,) linear Rec.709, each 0 or more
position   (3,) world, in the scene's length unit; a sun has none that matters
direction  (3,) where it shines to; any length but 0 for SUN, SPOT and AREA
power      W; for a SUN W/m^2. Mode `paper` asks only whether it is 0
name       for reports
visible    False: off, left out of every sum

For irradiance (mode `paper` does not look at it); lengths in the scene's unit, angles in radians; what the kind does not
have is not looked at, and its attribute is the default:
radius        POINT and SPOT: of the glowing ball, 0 or more
soft_falloff  POINT and SPOT: True, a disk that always faces the lit point (as Blender by default); False, a ball
sun_angle     SUN: full angle it is seen under, 0 to pi
spot_angle    SPOT: full angle of the cone, 0 (no light) to pi
spot_blend    SPOT: fraction of the cone that fades, 0 to 1
spot_cosine   SPOT: also times the cosine to its axis (Blender 3.4 does this, 4.5 and later do not)
area_shape    AREA: "RECTANGLE" ("SQUARE") or "ELLIPSE" ("DISK")
size_x, size_y, tangent  AREA: full widths along and across tangent, a world direction; a width of 0 gives no light
spread        AREA: full angle it shines into, 0 (no light) to pi (Lambert emitter)
Raises ValueError naming light, field, value and what is allowed.)");
    light
        .def(py::init(&make_light), "kind"_a = "POINT", "color"_a = py::make_tuple(1.0, 1.0, 1.0),
             "position"_a = py::make_tuple(0.0, 0.0, 0.0), "direction"_a = py::make_tuple(0.0, 0.0, -1.0),
             "power"_a = 1.0, "name"_a = "", "visible"_a = true, py::kw_only(), "radius"_a = 0.0,
             "soft_falloff"_a = true, "sun_angle"_a = 0.0, "spot_angle"_a = std::numbers::pi / 4,
             "spot_blend"_a = 0.15, "spot_cosine"_a = false, "area_shape"_a = "RECTANGLE",
             "size_x"_a = AreaLight{}.size_x, "size_y"_a = AreaLight{}.size_y,
             "tangent"_a = py::make_tuple(1.0, 0.0, 0.0), "spread"_a = std::numbers::pi)
        .def_property_readonly("kind", [](const Light& self) { return to_text(self.kind()); })
        .def_property_readonly("color", [](const Light& self) { return numpy::from_vec3(self.color()); })
        .def_property_readonly("position",
                               [](const Light& self) { return numpy::from_vec3(self.position()); })
        .def_property_readonly("direction",
                               [](const Light& self) { return numpy::from_vec3(self.direction()); })
        .def_property_readonly("power", &Light::power)
        .def_property_readonly("name", &Light::name)
        .def_property_readonly("visible", &Light::visible)
        .def_property_readonly(
            "is_on", [](const Light& self) { return is_on(self); },
            "False for a light that gives nothing: hidden, power 0 or black.")
        .def(
            "moved",
            [](const Light& self, py::handle motion) {
                return self.moved(numpy::to_matrix4(motion, "motion"));
            },
            "motion"_a,
            R"(The same light elsewhere: position, direction and tangent carried along.

motion  (4, 4), on column vectors: a rotation, orthogonal to 1e-5, mirroring or not, and a translation. The inverse of a
        body's motion gives the light as seen from the body. Raises ValueError on any other.)")
        .def(
            "__eq__", [](const Light& self, const Light& other) { return self == other; }, py::is_operator())
        .def("__hash__",
             [](const Light& self) {
                 // By Python's hash: 0 and -0, which are equal, have one.
                 return py::hash(py::make_tuple(self.name(), to_text(self.kind()), self.power(),
                                                self.position().x, self.position().y, self.position().z));
             })
        .def("__repr__", [](const Light& self) {
            return "<skinglow.Light \"" + self.name() + "\" " + std::string(to_text(self.kind())) +
                   ", color " + to_text(self.color()) + ", power " + to_text(self.power()) +
                   (self.visible() ? ">" : ", hidden>");
        });
    def_shape_fields<PointLight>(light);
    def_shape_fields<SunLight>(light);
    def_shape_fields<SpotLight>(light);
    def_shape_fields<AreaLight>(light);
}
