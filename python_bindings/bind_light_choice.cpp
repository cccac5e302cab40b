#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/rig.h>

#include <optional>
#include <string>
#include <vector>

#include "geometry/vector.h"
#include "numpy_conversion.h"
#include "rig/light_bounds.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;
using skinglow::numpy::without_gil;

namespace {

Box to_box(py::handle box_min, py::handle box_max) {
    return {numpy::to_vec3(box_min, "box_min"), numpy::to_vec3(box_max, "box_max")};
}

py::dict to_dict(const CullingResult& result) {
    py::list dropped;
    for (const DroppedLights& group : result.dropped) {
        dropped.append(py::dict("lights"_a = group.lights, "reason"_a = to_text(group.reason),
                                "bound"_a = numpy::from_vec3(group.bound)));
    }
    return py::dict("kept"_a = result.kept, "dropped"_a = dropped,
                    "bound"_a = numpy::from_vec3(result.bound));
}

py::list report_as_dicts(py::handle lights, py::handle point, py::handle normal,
                         const std::vector<bool>& occluded,
                         const std::optional<std::vector<std::int64_t>>& kept) {
    std::optional<glm::dvec3> facing;
    if (!normal.is_none()) facing = numpy::to_vec3(normal, "normal");
    const glm::dvec3 at = numpy::to_vec3(point, "point");
    const PreparedRig rig = numpy::to_rig(lights);
    std::optional<std::vector<std::size_t>> left;
    if (kept) left.emplace();
    for (std::size_t i = 0; kept && i < kept->size(); ++i)
        left->push_back(numpy::to_count((*kept)[i], "kept[" + std::to_string(i) + "]"));
    const std::vector<LightReportEntry> report =
        without_gil([&] { return light_report(rig, at, facing, occluded, left); });
    py::list entries;
    for (const LightReportEntry& e : report) {
        entries.append(py::dict("index"_a = e.index, "name"_a = e.name, "kind"_a = to_text(e.kind),
                                "distance"_a = e.distance, "axis_angle"_a = e.axis_angle,
                                "normal_angle"_a = e.normal_angle, "weight"_a = numpy::from_vec3(e.weight),
                                "share"_a = e.share, "state"_a = to_text(e.state)));
    }
    return entries;
}

}  // namespace

void bind_light_choice(py::module_& m) {
    py::class_<PreparedRig>(
        m, "PreparedRig",
        R"(Lights made ready for all that is asked of them. Every function that takes lights takes a rig: it saves
preparing them again.

lights  sequence of Light; indices in results are positions in it. Make it anew when a light changes.)")
        .def(py::init(&numpy::to_rig), "lights"_a)
        .def("__len__", &PreparedRig::size)
        .def_property_readonly("lights", &PreparedRig::lights, "[Light]")
        .def(
            "cull",
            [](const PreparedRig& self, py::handle box_min, py::handle box_max, double tolerance) {
                const Box box = to_box(box_min, box_max);
                return to_dict(without_gil([&] { return self.cull(box, tolerance); }));
            },
            "box_min"_a, "box_max"_a, "tolerance"_a,
            R"(Leaves out lights whose sum changes no channel by more than tolerance (W/m^2), proven for every point of the
box and every normal there. A tolerance of 0 leaves out only what gives nothing.

Returns a dict: kept (indices, ascending), dropped (dicts of lights, reason, bound; reason is "off", "unreachable" or
"negligible"), bound (3,), the sum of theirs. Raises ValueError naming what is wrong.)");
    m.def(
        "merge_identical",
        [](py::handle lights) {
            const PreparedRig rig = numpy::to_rig(lights);
            return without_gil([&] { return merge_identical(rig.lights()); });
        },
        "lights"_a,
        "Lights that shine alike from one position in one direction as one each, their light added; those "
        "that "
        "are off go.");
    m.def(
        "object_irradiance_error",
        [](py::handle lights, py::handle point, py::handle box_min, py::handle box_max,
           const std::optional<std::pair<py::object, double>>& facing) {
            const PreparedRig rig = numpy::to_rig(lights);
            const glm::dvec3 at = numpy::to_vec3(point, "point");
            const Box box = to_box(box_min, box_max);
            std::optional<NormalCone> cone;
            if (facing) cone = {unit(numpy::to_vec3(facing->first, "axis of facing")), facing->second};
            return numpy::from_vec3(without_gil([&] { return object_irradiance_error(rig, at, box, cone); }));
        },
        "lights"_a, "point"_a, "box_min"_a, "box_max"_a, "facing"_a = py::none(),
        R"(Upper bound (3,), W/m^2, of how far object_irradiance(lights, p) is from object_irradiance(lights, point) for p in
the box: what one weight for the whole object may be off.
facing  None: the receiver's cosine is left out; or (axis (3,), half angle in radians), the cone of the far side's normals,
        as normal_cone gives it: the bound then holds for irradiance with its cosine on each of them.)");
    m.def("light_report", &report_as_dicts, "lights"_a, "point"_a, "normal"_a = py::none(),
          "occluded"_a = std::vector<bool>{}, "kept"_a = py::none(),
          R"(What each light does for a point, in mode `physical`: a list of dicts, one per light.

index, name, kind, distance (0 for a sun), axis_angle (from the light's axis, radians), normal_angle (from the normal, or
None), weight (3,) W/m^2, share of the luminance of all (0 to 1), and state: "shines", or why it gives nothing: "hidden",
"zero power", "black", "no width", "occluded", "culled", "behind light", "outside cone", "behind" or "too weak".
normal    None: a surface that faces each light; else (3,), and the weight has its cosine
occluded  empty, or one bool per light; kept  None, or the indices that culling kept)");
}
