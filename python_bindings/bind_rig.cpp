#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"
#include "rig_files/file_error.h"
#include "rig_files/light_rig.h"
#include "rig_files/studio_light.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

/// A rig, and what of a studio light could not be taken over.
struct FoundRig {
    LightRig rig;
    std::vector<std::string> notes;
};

/// A file's name as bytes that `decode` takes: UTF-8, or on POSIX whatever bytes it has.
std::string text_of(const std::filesystem::path& path) {
    const std::u8string text = path.u8string();
    return {text.begin(), text.end()};
}

/// Text that may hold a file's name. POSIX' names are any bytes: what is no UTF-8 becomes what os.fsdecode makes of it.
py::str decode(const std::string& text) {
    PyObject* decoded =
        PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
    if (decoded == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(decoded);
}

[[noreturn]] void raise_value_error(const std::string& text) {
    PyErr_SetObject(PyExc_ValueError, decode(text).ptr());
    throw py::error_already_set();
}

FoundRig read_any(const std::filesystem::path& path, py::handle camera_rotation) {
    const bool studio_light = small_extension(path) == ".sl";
    if (!camera_rotation.is_none() && !studio_light) {
        refuse_argument("camera_rotation", "given for " + text_of(path),
                        "it with a studio light (*.sl) only");
    }
    const glm::dmat3 camera = camera_rotation.is_none()
                                  ? front_view
                                  : camera_axes(numpy::to_vec3(camera_rotation, "camera_rotation"));
    const py::gil_scoped_release release;
    if (!studio_light) return {read_light_rig(path), {}};
    StudioLight studio = read_studio_light(path, camera);
    LightRig rig;
    rig.name = text_of(path.stem());
    rig.lights = std::move(studio.lights);
    return {std::move(rig), std::move(studio.notes)};
}

FoundRig read_or_raise(const std::filesystem::path& path, py::handle camera_rotation) {
    try {
        return read_any(path, camera_rotation);
    } catch (const FileError& error) {
        raise_value_error(error.what());
    } catch (const std::invalid_argument& error) {
        raise_value_error(error.what());
    }
}

}  // namespace

void bind_rig(py::module_& m) {
    py::class_<FoundRig>(m, "LightRig", R"(Lights around a point of skin, as `read_light_rig` found them.

name          of the rig; "" where the file gives none
point         (3,) where distances are measured from, world
coefficients  (3,) constant, linear and quadratic of Eq. 2
blood_weight  (3,) B of Eq. 1
lights        [Light]
notes         [str] what the file holds and no light can: a studio light's ambient light, soft wrap, highlights)")
        .def_property_readonly("name", [](const FoundRig& self) { return decode(self.rig.name); })
        .def_property_readonly("point", [](const FoundRig& self) { return numpy::from_vec3(self.rig.point); })
        .def_property_readonly("coefficients",
                               [](const FoundRig& self) {
                                   const AttenuationCoefficients& k = self.rig.coefficients;
                                   return numpy::from_vec3({k.constant, k.linear, k.quadratic});
                               })
        .def_property_readonly("blood_weight",
                               [](const FoundRig& self) { return numpy::from_vec3(self.rig.blood_weight); })
        .def_property_readonly("lights", [](const FoundRig& self) { return self.rig.lights; })
        .def_readonly("notes", &FoundRig::notes);

    m.def(
        "read_light_rig", &read_or_raise, "path"_a, "camera_rotation"_a = py::none(),
        R"(Reads a light rig: a rig file (JSON, docs/rig_format.md) or one of Blender's studio lights (*.sl).

camera_rotation  (3,) for *.sl: Blender rotation (XYZ Euler, radians) of the camera that its lights hang on; None:
                 Blender's front view, (pi/2, 0, 0)
Strict: raises ValueError naming file, key and line on anything that the format does not allow.)");
}
