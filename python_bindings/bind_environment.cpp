#include <pybind11/pybind11.h>
#include <skinglow/environment.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <span>
#include <string>
#include <vector>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

constexpr const char* allowed_radiance = "finite numbers of at most 1e30 W/(m^2 sr)";

/// Names the entry of what is given, which the core knows as coefficients or pixels.
void require_range(const numpy::Array& radiance, double largest, const char* allowed) {
    const auto row = static_cast<std::size_t>(radiance.shape(radiance.ndim() - 1));
    for (std::size_t i = 0; i < static_cast<std::size_t>(radiance.size()); ++i) {
        if (std::abs(radiance.data()[i]) <= largest) continue;
        std::string at = std::to_string(i / row);
        if (radiance.ndim() == 3) {
            const auto width = static_cast<std::size_t>(radiance.shape(1));
            at = std::to_string(i / row / width) + ", " + std::to_string(i / row % width);
        }
        refuse_argument("radiance[" + at + "]", to_text(radiance.data()[i]), allowed);
    }
}

Environment make_environment(py::handle radiance) {
    const numpy::Array values = numpy::to_array(radiance, "radiance");
    if (values.ndim() == 1) return Environment(numpy::to_vec3(radiance, "radiance"));
    if (values.ndim() == 2 && values.shape(0) == 9 && values.shape(1) == 3) {
        std::array<glm::dvec3, 9> coefficients;
        require_range(values, Environment::max_coefficient,
                      "finite numbers of at most 4e30: no radiance of up to 1e30 W/(m^2 sr) has larger ones");
        const std::vector<glm::dvec3> rows = numpy::to_vec3s(radiance, "radiance");
        std::copy(rows.begin(), rows.end(), coefficients.begin());
        return Environment(coefficients);
    }
    if (values.ndim() != 3 || values.shape(2) != 3 || values.size() == 0) {
        refuse_argument("radiance", "of shape " + numpy::shape_text(values),
                        "shape (3,), (9, 3) or (height, width, 3), with a pixel at least");
    }
    require_range(values, max_radiance, allowed_radiance);
    const auto height = static_cast<std::size_t>(values.shape(0));
    const auto width = static_cast<std::size_t>(values.shape(1));
    const py::gil_scoped_release release;
    return Environment::from_equirectangular(
        {reinterpret_cast<const glm::dvec3*>(values.data()), height * width}, width, height);
}

py::array environment_irradiance(const Environment& self, py::handle normals,
                                 const AngularWeight* angular_weight) {
    const std::vector<glm::dvec3> directions = numpy::to_vec3s(normals, "normals");
    return numpy::from_vec3s(numpy::without_gil([&] {
        std::vector<glm::dvec3> result;
        result.reserve(directions.size());
        for (const glm::dvec3& n : directions) {
            require_finite("normals", n);
            result.push_back(n == glm::dvec3(0.0) ? n : self.irradiance(unit(n), angular_weight));
        }
        return result;
    }));
}

Environment environment_of_image(py::handle image_pixels, const std::string& projection, bool bottom_first) {
    const numpy::FloatArray pixels = numpy::to_floats(image_pixels, "pixels");
    if (pixels.ndim() != 3) {
        refuse_argument("pixels", "of shape " + numpy::shape_text(pixels), "shape (height, width, channels)");
    }
    if (projection != "EQUIRECTANGULAR" && projection != "MIRROR_BALL") {
        refuse_argument("projection", projection, "EQUIRECTANGULAR or MIRROR_BALL");
    }
    const RadianceImage image{
        .values = {pixels.data(), static_cast<std::size_t>(pixels.size())},
        .width = static_cast<std::size_t>(pixels.shape(1)),
        .height = static_cast<std::size_t>(pixels.shape(0)),
        .channels = static_cast<std::size_t>(pixels.shape(2)),
        .bottom_first = bottom_first,
    };
    const py::gil_scoped_release release;
    return projection == "MIRROR_BALL" ? Environment::from_mirror_ball(image)
                                       : Environment::from_equirectangular(image);
}

Environment rotated_environment(const Environment& self, py::handle rotation) {
    const std::vector<glm::dvec3> rows = numpy::to_vec3s(rotation, "rotation");
    if (rows.size() != 3)
        refuse_argument("rotation", "of " + std::to_string(rows.size()) + " rows", "shape (3, 3)");
    return self.rotated(glm::transpose(glm::dmat3(rows[0], rows[1], rows[2])));
}

}  // namespace

void bind_environment(py::module_& m) {
    py::class_<Environment>(
        m, "Environment",
        R"(The world's light as nine spherical-harmonic coefficients (Ramamoorthi and Hanrahan 2001).

radiance  (3,) constant, W/(m^2 sr), 0 to 1e30; or (9, 3) coefficients, orthonormal, order l, m, of at most 4e30; or an
          equirectangular image (height, width, 3), of at most 1e30, row 0 looking up to +z, columns as in Blender (the
          center looks along +x, a quarter from the left along +y). Blender's own pixels start at the bottom: flip them.
Raises ValueError naming the entry.)")
        .def(py::init(&make_environment), "radiance"_a)
        .def_static("from_image", &environment_of_image, "pixels"_a, py::kw_only(),
                    "projection"_a = "EQUIRECTANGULAR", "bottom_first"_a = false,
                    R"(From float32 pixels as they are, which are not copied: for large images.

pixels        (height, width, channels), of at most 1e30; R, G, B first, or gray where there are fewer than 3 channels
projection    'EQUIRECTANGULAR', or 'MIRROR_BALL': the square picture of a mirrored ball seen along +y, z up
bottom_first  whether the first row is the lowest, as in Blender's pixels. Raises ValueError naming what is wrong.)")
        .def(
            "rotated", &rotated_environment, "rotation"_a,
            R"(The same light with the whole world turned: what came from direction d comes from rotation @ d.

rotation  (3, 3), orthogonal to 1e-5, mirroring or not. Exact. Raises ValueError where it is not orthogonal.)")
        .def("irradiance", &environment_irradiance, "normals"_a, "angular_weight"_a = py::none(),
             "W/m^2 on surfaces along normals (n, 3), any length (0 receives nothing); not below 0. Shape "
             "(n, 3).")
        .def_property_readonly(
            "mean_irradiance",
            [](const Environment& self) { return numpy::from_vec3(self.mean_irradiance()); },
            "pi times the mean radiance, (3,): the part of the environment in the weight of a whole object.")
        .def_property_readonly(
            "mean_irradiance_error",
            [](const Environment& self) { return numpy::from_vec3(self.mean_irradiance_error()); },
            "(3,): no irradiance on any normal is further from mean_irradiance than this.")
        .def_property_readonly(
            "coefficients",
            [](const Environment& self) {
                return numpy::from_vec3s({self.coefficients().begin(), self.coefficients().end()});
            },
            "(9, 3), of the radiance.");
}
