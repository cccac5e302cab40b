#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/slab.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bind_incidence.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

// Any sequence of Layer.
std::vector<Layer> to_layers(py::handle value) {
    if (py::isinstance<Layer>(value)) refuse_argument("layers", "one Layer", "a sequence of skinglow.Layer");
    std::vector<Layer> layers;
    if (!py::isinstance<py::iterable>(value)) {
        refuse_argument("layers", py::repr(value).cast<std::string>(), "a sequence of skinglow.Layer");
    }
    for (const py::handle item : value) {
        if (!py::isinstance<Layer>(item)) {
            refuse_argument("layers[" + std::to_string(layers.size()) + "]",
                            py::repr(item).cast<std::string>(), "a skinglow.Layer");
        }
        layers.push_back(item.cast<Layer>());
    }
    return layers;
}

std::string layer_text(const Layer& self) {
    return "Layer(refractive_index=" + to_text(self.refractive_index) +
           ", absorption=" + to_text(self.absorption) + ", scattering=" + to_text(self.scattering) +
           ", anisotropy=" + to_text(self.anisotropy) + ", thickness=" + to_text(self.thickness) + ")";
}

std::string result_text(const SlabResult& self) {
    std::string text = "SlabResult(reflectance=" + to_text(self.reflectance) +
                       ", transmittance=" + to_text(self.transmittance) +
                       ", unscattered=" + to_text(self.unscattered) + ", absorbed=(";
    for (std::size_t i = 0; i < self.absorbed.size(); ++i)
        text += (i == 0 ? "" : ", ") + to_text(self.absorbed[i]);
    return text + "))";
}

SlabResult slab_of_sequence(py::handle layers, py::handle incidence, double n_above, double n_below,
                            int streams) {
    const std::vector<Layer> stack = to_layers(layers);
    const Incidence light = to_incidence(incidence);
    const py::gil_scoped_release released;
    return slab(stack, light, n_above, n_below, streams);
}

py::dict directional(py::handle layers, double n_above, double n_below, int streams) {
    const std::vector<Layer> stack = to_layers(layers);
    DirectionalTransmittance result;
    {
        const py::gil_scoped_release released;
        result = directional_transmittance(stack, n_above, n_below, streams);
    }
    return py::dict("mu"_a = numpy::from_doubles(std::move(result.mu)),
                    "weight"_a = numpy::from_doubles(std::move(result.weight)),
                    "transmittance"_a = numpy::from_doubles(std::move(result.transmittance)));
}

ThicknessCurve make_curve(py::handle layers, std::int64_t variable_layer, py::handle incidence,
                          double n_above, double n_below, int streams) {
    const std::vector<Layer> stack = to_layers(layers);
    const Incidence light = to_incidence(incidence);
    const std::size_t variable = numpy::to_count(variable_layer, "variable_layer");
    const py::gil_scoped_release released;
    return {stack, variable, light, n_above, n_below, streams};
}

py::array curve_transmittance(const ThicknessCurve& self, py::handle thickness_mm) {
    const numpy::Array thickness = numpy::to_array(thickness_mm, "thickness_mm");
    if (thickness.ndim() != 1) {
        refuse_argument("thickness_mm", "of shape " + numpy::shape_text(thickness), "shape (n,)");
    }
    const std::span<const double> values(thickness.data(), static_cast<std::size_t>(thickness.size()));
    std::vector<double> out(values.size());
    {
        const py::gil_scoped_release released;
        self.transmittance(values, out);
    }
    return numpy::from_doubles(std::move(out));
}

}  // namespace

void bind_slab(py::module_& m) {
    py::class_<Layer>(m, "Layer", R"(A plane layer of turbid medium; scattering follows Henyey and Greenstein.

refractive_index  1 to 100
absorption        absorption coefficient, 1/mm, 0 or more
scattering        scattering coefficient, 1/mm, 0 or more
anisotropy        mean cosine of the scattering angle, above -1 and below 1
thickness         mm, 0 or more; infinity (a half-space) in the last layer alone

Values are checked where a layer is used, so that the message can say which layer it is.)")
        .def(py::init([](double refractive_index, double absorption, double scattering, double anisotropy,
                         double thickness) {
                 return Layer{refractive_index, absorption, scattering, anisotropy, thickness};
             }),
             "refractive_index"_a = 1.4, "absorption"_a = 0.0, "scattering"_a = 0.0, "anisotropy"_a = 0.0,
             "thickness"_a = 0.0)
        .def_readwrite("refractive_index", &Layer::refractive_index)
        .def_readwrite("absorption", &Layer::absorption)
        .def_readwrite("scattering", &Layer::scattering)
        .def_readwrite("anisotropy", &Layer::anisotropy)
        .def_readwrite("thickness", &Layer::thickness)
        .def(
            "__eq__", [](const Layer& self, const Layer& other) { return self == other; }, py::is_operator())
        .def("__repr__", &layer_text);

    py::class_<SlabResult>(m, "SlabResult",
                           "What becomes of light on a slab, as fractions of the incident flux.")
        .def_readonly("reflectance", &SlabResult::reflectance,
                      "Leaves above, the specular reflection at the surface included.")
        .def_readonly("transmittance", &SlabResult::transmittance,
                      "Leaves below, the unscattered part included.")
        .def_readonly("unscattered", &SlabResult::unscattered, "Leaves below without having been scattered.")
        .def_property_readonly(
            "absorbed",
            [](const SlabResult& self) { return numpy::from_doubles(std::vector<double>(self.absorbed)); },
            "(n_layers,): absorbed in each layer.")
        .def("__repr__", &result_text);

    m.def(
        "slab", &slab_of_sequence, "layers"_a, "incidence"_a = "normal", "n_above"_a = 1.0, "n_below"_a = 1.0,
        "streams"_a = 16,
        R"(Reflectance, transmittance and absorption of plane layers, top to bottom: the transport equation, solved.

layers            sequence of Layer
incidence         "normal", "diffuse", or the cosine to the normal, above 0 and at most 1
n_above, n_below  refractive index outside, 1 to 100
streams           directions per hemisphere, even, 4 to 128; docs/accuracy.md says what each buys
Raises ValueError naming what is wrong, also where the streams are too few, so that a fraction would be negative.)");

    m.def(
        "directional_transmittance", &directional, "layers"_a, "n_above"_a = 1.0, "n_below"_a = 1.0,
        "streams"_a = 16,
        R"(Transmittance for beams from all stream directions, by one solve: {"mu", "weight", "transmittance"}.

mu is the cosine outside, the first is 1; the weights are those of a quadrature over it. Arguments as for slab.)");

    py::class_<ThicknessCurve>(m, "ThicknessCurve",
                               R"(Transmittance of layers of which one takes any thickness.

Each layer's transport problem is solved once, here; a thickness then costs a small solve. Arguments as for slab, and
variable_layer, the index of the layer whose own thickness is not read.)")
        .def(py::init(&make_curve), "layers"_a, "variable_layer"_a = 0, "incidence"_a = "diffuse",
             "n_above"_a = 1.0, "n_below"_a = 1.0, "streams"_a = 16)
        .def("transmittance", &curve_transmittance, "thickness_mm"_a,
             "(n,) mm in any order to (n,) fractions of the incident flux.")
        .def_property_readonly("decay_rate", &ThicknessCurve::decay_rate,
                               "1/mm: the rate at which log transmittance falls in the end.");
}
