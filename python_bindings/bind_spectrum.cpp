#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/spectrum.h>

#include <algorithm>
#include <string>
#include <vector>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

Spectrum to_spectrum(py::handle values, const char* name) {
    const numpy::Array array = numpy::to_array(values, name);
    if (array.ndim() != 1 || array.shape(0) != static_cast<py::ssize_t>(spectral_samples)) {
        refuse_argument(name, "of shape " + numpy::shape_text(array),
                        "shape (81,), at SAMPLE_WAVELENGTHS_NM");
    }
    Spectrum spectrum{};
    std::copy(array.data(), array.data() + spectral_samples, spectrum.begin());
    return spectrum;
}

py::array from_spectrum(const Spectrum& spectrum) {
    return numpy::from_doubles(std::vector<double>(spectrum.begin(), spectrum.end()));
}

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

}  // namespace

void bind_spectrum(py::module_& m) {
    Spectrum wavelengths{};
    for (std::size_t k = 0; k < spectral_samples; ++k) wavelengths[k] = sample_wavelength_nm(k);
    m.attr("SAMPLE_WAVELENGTHS_NM") = read_only(from_spectrum(wavelengths));  // (81,): 380, 385, ... 780
    m.attr("D65_SPECTRUM") = read_only(from_spectrum(d65_spectrum()));        // (81,)
    m.def(
        "rgb_spectrum",
        [](py::handle rgb) { return from_spectrum(rgb_spectrum(numpy::to_vec3(rgb, "rgb"))); }, "rgb"_a,
        "The spectrum that stands for linear Rec.709 light: D65 times the basis of Mallett and Yuksel 2019, "
        "shape (81,).");
    m.def(
        "blackbody_spectrum", [](double kelvin) { return from_spectrum(blackbody_spectrum(kelvin)); },
        "temperature_k"_a, "Planck's law relative to its largest sample, shape (81,); 500 to 100000 K.");
    m.def(
        "line_spectrum",
        [](double center, double fwhm) { return from_spectrum(line_spectrum(center, fwhm)); }, "center_nm"_a,
        "fwhm_nm"_a,
        "A lamp of one Gaussian line, total power 1, shape (81,); center 380 to 780 nm, width above 0 to 400 "
        "nm.");
    m.def(
        "tabulated_spectrum",
        [](py::handle wavelength_nm, py::handle power) {
            const numpy::Array nm = numpy::to_array(wavelength_nm, "wavelength_nm");
            const numpy::Array values = numpy::to_array(power, "power");
            return from_spectrum(
                tabulated_spectrum({nm.data(), static_cast<std::size_t>(nm.size())},
                                   {values.data(), static_cast<std::size_t>(values.size())}));
        },
        "wavelength_nm"_a, "power"_a,
        "A measured lamp carried to the 5 nm grid with its power kept, shape (81,); 0 outside the table.");
    m.def(
        "spectral_color",
        [](py::handle spectrum, const py::object& transmittance) {
            const Spectrum lamp = to_spectrum(spectrum, "spectrum");
            if (transmittance.is_none()) return numpy::from_vec3(spectral_color(lamp));
            return numpy::from_vec3(spectral_color(lamp, to_spectrum(transmittance, "transmittance")));
        },
        "spectrum"_a, "transmittance"_a = py::none(),
        R"(Linear Rec.709 of a lamp scaled to luminance 1, shape (3,), or of its light behind a filter on the same scale.

spectrum, transmittance  (81,) at SAMPLE_WAVELENGTHS_NM. May lie outside the gamut (negative).)");
    m.def(
        "transmission_matrix",
        [](py::handle transmittance) {
            const glm::dmat3 matrix = transmission_matrix(to_spectrum(transmittance, "transmittance"));
            py::array_t<double> rows({3, 3});
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) rows.mutable_at(i, j) = matrix[j][i];
            }
            return rows;
        },
        "transmittance"_a,
        "The (3, 3) matrix by which a filter, (81,), acts on linear Rec.709 light; the identity for a filter "
        "of 1.");
}
