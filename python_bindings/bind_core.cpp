#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/light_weights.h>
#include <skinglow/lut.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

AttenuationCoefficients to_coefficients(py::handle value) {
    const glm::dvec3 k = numpy::to_vec3(value, "coefficients");
    return {k.x, k.y, k.z};
}

py::object attenuation_of_array(py::handle distance, py::handle coefficients) {
    const AttenuationCoefficients k = to_coefficients(coefficients);
    const numpy::Array distances = numpy::to_array(distance, "distance");
    py::array_t<double> result(
        std::vector<py::ssize_t>(distances.shape(), distances.shape() + distances.ndim()));
    double* out = result.mutable_data();
    for (py::ssize_t i = 0; i < distances.size(); ++i) out[i] = attenuation(distances.data()[i], k);
    return distances.ndim() == 0 ? py::object(py::float_(out[0])) : py::object(std::move(result));
}

BaseLut base_lut_of_array(py::handle values, double max_thickness_mm) {
    const numpy::Array table = numpy::to_array(values, "values");
    if (table.ndim() == 1) {
        return BaseLut::from_gray({table.data(), static_cast<std::size_t>(table.size())}, max_thickness_mm);
    }
    if (table.ndim() != 3 || table.shape(1) != 3 || table.shape(2) != 3) {
        refuse_argument("values", "of shape " + numpy::shape_text(table), "shape (size,) or (size, 3, 3)");
    }
    std::vector<glm::dmat3> matrices(static_cast<std::size_t>(table.shape(0)));
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        const double* rows = table.data() + 9 * i;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) matrices[i][column][row] = rows[3 * row + column];
        }
    }
    return {std::move(matrices), max_thickness_mm};
}

void bind_weights(py::module_& m) {
    m.def(
        "attenuation", &attenuation_of_array, "distance"_a, "coefficients"_a = py::make_tuple(1.0, 0.0, 1.0),
        R"(Eq. 2 of Kim et al.: min(1 / (k_c + k_l d + k_q d^2), 1), in [0, 1]; 1 where all coefficients are 0.

distance      number or array of any shape, in the scene's length unit, finite, 0 or more
coefficients  (k_c, k_l, k_q), finite, 0 or more
Returns a float or an array of the same shape. Raises ValueError on anything else.)");
    m.def(
        "light_weights",
        [](py::handle lights, py::handle point, py::handle coefficients) {
            const PreparedRig rig = numpy::to_rig(lights);
            const glm::dvec3 at = numpy::to_vec3(point, "point");
            const AttenuationCoefficients k = to_coefficients(coefficients);
            return numpy::from_vec3s(numpy::without_gil([&] { return light_weights(rig.lights(), at, k); }));
        },
        "lights"_a, "point"_a, "coefficients"_a = py::make_tuple(1.0, 0.0, 1.0),
        R"(Each light's term of Eq. 3, color * attenuation(distance to point), shape (n, 3), linear Rec.709.

A sun has no distance: its attenuation is 1. A light that is off (hidden, power 0, black) gives (0, 0, 0).
point  (3,), in the scene's length unit. Raises ValueError naming what is wrong.)");
    m.def(
        "light_weight",
        [](py::handle lights, py::handle point, py::handle coefficients) {
            const PreparedRig rig = numpy::to_rig(lights);
            const glm::dvec3 at = numpy::to_vec3(point, "point");
            const AttenuationCoefficients k = to_coefficients(coefficients);
            return numpy::from_vec3(numpy::without_gil([&] { return light_weight(rig.lights(), at, k); }));
        },
        "lights"_a, "point"_a, "coefficients"_a = py::make_tuple(1.0, 0.0, 1.0),
        R"(Eq. 3, the sum of light_weights, shape (3,); zeros without lights.

The order of the lights does not matter beyond the last bits: the sum is compensated.)");
}

void bind_tables(py::module_& m) {
    py::class_<BaseLut>(m, "BaseLut", R"(What thin skin does to light, before any light is known.

values            (size,) brightness, finite, 0 or more; or (size, 3, 3) matrices M(d) on linear Rec.709, finite
max_thickness_mm  thickness of the last entry, above 0; entry i stands at i / (size - 1) of it
size is 1 to 65536. Raises ValueError naming the entry and what is allowed.)")
        .def(py::init(&base_lut_of_array), "values"_a, "max_thickness_mm"_a)
        .def_property_readonly(
            "matrices",
            [](py::object self) {
                return numpy::view_of_matrices(self.cast<const BaseLut&>().matrices(), self);
            },
            "(size, 3, 3), [entry, row, column]; a read-only view.")
        .def_property_readonly(
            "thickness_mm",
            [](const BaseLut& self) { return numpy::from_doubles(self.axis().thickness_mm()); },
            "(size,), ascending from 0 to max_thickness_mm, mm.")
        .def_property_readonly("size", &BaseLut::size, "Number of entries.")
        .def_property_readonly(
            "max_thickness_mm", [](const BaseLut& self) { return self.axis().max_thickness_mm(); }, "mm.")
        .def_property_readonly(
            "texel_mapping",
            [](const BaseLut& self) {
                return py::make_tuple(self.axis().texel_scale(), self.axis().texel_offset());
            },
            R"((scale, offset): the coordinate in [0, 1] of a thickness in an image that holds entry i in texel i is
scale * thickness_mm + offset. Clamp the image at its ends ("extend").)")
        .def("__len__", &BaseLut::size)
        .def("__repr__", [](const BaseLut& self) {
            return "<skinglow.BaseLut of " + std::to_string(self.size()) + " entries, 0 to " +
                   to_text(self.axis().max_thickness_mm()) + " mm>";
        });
    m.def(
        "recolor",
        [](const BaseLut& base, py::handle weight) {
            const glm::dvec3 by = numpy::to_vec3(weight, "weight");
            // Below it the work takes less than about 10 us, of which giving the lock up and back is a tenth.
            constexpr std::size_t worth_releasing = 2048;
            std::vector<glm::dvec3> colors = base.size() < worth_releasing
                                                 ? recolor(base, by)
                                                 : numpy::without_gil([&] { return recolor(base, by); });
            return numpy::from_vec3s(std::move(colors));
        },
        "base"_a, "weight"_a,
        R"(The recolored table M(d) @ weight, shape (size, 3), linear Rec.709; values above 1 are kept.

Mode `paper` (Eq. 1): a gray base and weight = B + L. Mode `physical`: weight = E on the far side, W/m^2.
weight  (3,), finite. Raises ValueError on bad input or where a product is beyond the largest double.)");
    m.def(
        "table_at",
        [](py::handle colors, const std::pair<double, double>& texel_mapping, py::handle thickness_mm) {
            const std::vector<glm::dvec3> table = numpy::to_vec3s(colors, "colors");
            const numpy::Array thickness = numpy::to_array(thickness_mm, "thickness_mm");
            if (thickness.ndim() != 1) {
                refuse_argument("thickness_mm", "of shape " + numpy::shape_text(thickness), "shape (k,)");
            }
            const std::span<const double> at(thickness.data(), static_cast<std::size_t>(thickness.size()));
            return numpy::from_vec3s(numpy::without_gil(
                [&] { return table_at(table, texel_mapping.first, texel_mapping.second, at); }));
        },
        "colors"_a, "texel_mapping"_a, "thickness_mm"_a,
        R"(What an image of a table shows at a thickness, (k, 3): linear between texel centers, its ends continued.

colors         (size, 3), as recolor gives them, finite
texel_mapping  (scale, offset), as BaseLut.texel_mapping
thickness_mm   (k,), finite. Raises ValueError naming the entry.)");
    m.def(
        "six_gaussian_lookup",
        [](std::int64_t size, double max_thickness_mm) {
            std::vector<glm::dvec3> colors;
            {
                const py::gil_scoped_release released;
                colors = six_gaussian_lookup({numpy::to_count(size, "size"), max_thickness_mm});
            }
            return numpy::from_vec3s(std::move(colors));
        },
        "size"_a = default_lut_size, "max_thickness_mm"_a = default_max_thickness_mm,
        R"(The existing method: a fixed reddish lookup, shape (size, 3), linear Rec.709, by the six-Gaussian skin profile
(d'Eon and Luebke, GPU Gems 3, 2007, ch. 14): sum of w_i exp(-d^2 / v_i). It knows no lights.)");
    m.def(
        "six_gaussian_base",
        [](std::int64_t size, double max_thickness_mm) {
            return six_gaussian_base({numpy::to_count(size, "size"), max_thickness_mm});
        },
        "size"_a = default_lut_size, "max_thickness_mm"_a = default_max_thickness_mm,
        py::call_guard<py::gil_scoped_release>(),
        "The default gray base lookup BLL of mode `paper`: the Rec.709 luminance of six_gaussian_lookup.");
    m.attr("PAPER_BLOOD_WEIGHT") =
        py::make_tuple(paper_blood_weight.x, paper_blood_weight.y, paper_blood_weight.z);
}

}  // namespace

void bind_core(py::module_& m) {
    bind_weights(m);
    bind_tables(m);
}
