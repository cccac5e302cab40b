#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <skinglow/angular_weight.h>
#include <skinglow/lut.h>
#include <skinglow/spectrum.h>
#include <skinglow/tissue.h>

#include <string>
#include <utility>

#include "bind_incidence.h"
#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;
using namespace py::literals;
using namespace skinglow;

namespace {

/// A Tissue with the line that says what it stands for; that of one made by hand is empty.
struct DescribedTissue {
    Tissue tissue;
    std::string description;
};

DescribedTissue with_changes(const Tissue& start, const std::string& description, const py::kwargs& changes) {
    DescribedTissue result{start, description};
    for (const auto& [key, value] : changes) {
        const auto name = key.cast<std::string>();
        const TissueParameter* found = nullptr;
        std::string names;
        for (const TissueParameter& parameter : tissue_parameters()) {
            if (parameter.name == name) found = &parameter;
            names += (names.empty() ? "" : ", ") + std::string(parameter.name);
        }
        if (found == nullptr) refuse_argument("tissue parameter", "\"" + name + "\"", names);
        if (!py::isinstance<py::float_>(value) && !py::isinstance<py::int_>(value) &&
            !PyNumber_Check(value.ptr())) {
            refuse_argument(name, py::repr(value).cast<std::string>(), "a number");
        }
        result.tissue.*found->field = numpy::to_number(value, name);
    }
    validate(result.tissue);
    return result;
}

std::string tissue_text(const DescribedTissue& self) {
    std::string text = "Tissue(";
    for (const TissueParameter& parameter : tissue_parameters()) {
        text += (text.back() == '(' ? "" : ", ") + std::string(parameter.name) + "=" +
                to_text(self.tissue.*parameter.field);
    }
    return text + ")";
}

std::string tissue_doc() {
    std::string text =
        "Skin as layers, epidermis / dermis / epidermis; it does not change once made. docs/optics.md has "
        "the sources.\n\n";
    const Tissue defaults;
    for (const TissueParameter& parameter : tissue_parameters()) {
        text += std::string(parameter.name) + "  " + std::string(parameter.description) + "; " +
                to_text(parameter.minimum) + " to " + to_text(parameter.maximum) +
                (parameter.unit == "1" ? "" : " " + std::string(parameter.unit)) + ", default " +
                to_text(defaults.*parameter.field) + "\n";
    }
    return text + "Raises ValueError naming parameter, value and range.";
}

void bind_tissue_class(py::module_& m) {
    static const std::string doc = tissue_doc();
    py::class_<DescribedTissue> tissue(m, "Tissue", doc.c_str());
    tissue.def(py::init([](const py::kwargs& values) { return with_changes({}, "", values); }))
        .def(
            "replace",
            [](const DescribedTissue& self, const py::kwargs& changes) {
                return with_changes(self.tissue, "", changes);
            },
            "A copy with some parameters changed, by name.")
        .def_readonly("description", &DescribedTissue::description,
                      "What a preset stands for; empty for a tissue made by hand.")
        .def("__eq__",
             [](const DescribedTissue& self, const py::object& other) {
                 if (!py::isinstance<DescribedTissue>(other)) return false;
                 const auto& second = other.cast<const DescribedTissue&>();
                 for (const TissueParameter& parameter : tissue_parameters()) {
                     if (self.tissue.*parameter.field != second.tissue.*parameter.field) return false;
                 }
                 return true;
             })
        .def("__hash__", [](const DescribedTissue& self) { return py::hash(py::str(tissue_text(self))); })
        .def("__repr__", [](const DescribedTissue& self) { return "skinglow." + tissue_text(self); });
    py::dict parameters;
    const Tissue defaults;
    for (const TissueParameter& parameter : tissue_parameters()) {
        tissue.def_property_readonly(
            std::string(parameter.name).c_str(),
            [field = parameter.field](const DescribedTissue& self) { return self.tissue.*field; },
            std::string(parameter.description).c_str());
        parameters[py::str(std::string(parameter.name))] =
            py::make_tuple(defaults.*parameter.field, parameter.minimum, parameter.maximum,
                           std::string(parameter.unit), std::string(parameter.description));
    }
    py::dict presets;
    for (const TissuePreset& preset : tissue_presets()) {
        presets[py::str(std::string(preset.name))] =
            py::cast(DescribedTissue{preset.tissue, std::string(preset.description)});
    }
    m.attr("TISSUE_PARAMETERS") = parameters;  // name: (default, minimum, maximum, unit, description)
    m.attr("TISSUE_PRESETS") = presets;        // name: Tissue, with its description
}

std::vector<double> one_dimension(py::handle values, const char* name) {
    const numpy::Array array = numpy::to_array(values, name);
    if (array.ndim() > 1)
        refuse_argument(name, "of shape " + numpy::shape_text(array), "a number or shape (n,)");
    return {array.data(), array.data() + array.size()};
}

py::array transmittance_of_arrays(const DescribedTissue& self, py::handle thickness, py::handle wavelength,
                                  py::handle incidence, int streams, int threads) {
    const auto thickness_mm = one_dimension(thickness, "thickness_mm");
    const auto wavelength_nm = one_dimension(wavelength, "wavelength_nm");
    const Incidence light = to_incidence(incidence);
    std::vector<double> result;
    {
        const py::gil_scoped_release released;
        result = transmittance(self.tissue, thickness_mm, wavelength_nm, light, streams, threads);
    }
    return numpy::from_doubles(std::move(result))
        .reshape(
            {static_cast<py::ssize_t>(thickness_mm.size()), static_cast<py::ssize_t>(wavelength_nm.size())});
}

void bind_skin_lut(py::module_& m) {
    using Released = py::call_guard<py::gil_scoped_release>;
    py::class_<SkinLutReport>(m, "SkinLutReport", R"(How base_lut solved a table, and how far off it is.

The error is in one norm: at each entry and for each primary, the largest difference in that column of M over the
largest number of the column (or over 1e-6 where skin lets even less through); of all these the largest.)")
        .def_readonly("streams", &SkinLutReport::streams, "Directions per hemisphere.")
        .def_readonly("estimated_error", &SkinLutReport::estimated_error,
                      "Bound on the error of the table, from that of random skins at these streams.");
    m.def(
        "base_lut",
        [](const DescribedTissue& self, std::int64_t size, double max_thickness_mm, double tolerance,
           int threads) {
            return base_lut(self.tissue, numpy::to_count(size, "size"), max_thickness_mm, tolerance, threads);
        },
        "tissue"_a, "size"_a = default_lut_size, "max_thickness_mm"_a = default_max_thickness_mm,
        "tolerance"_a = default_lut_tolerance, "threads"_a = 0, Released(),
        R"(The base lookup table of mode `physical`: M(d) of skin lit diffusely from behind, a BaseLut.

recolor(base_lut(tissue), E), with E the irradiance on the far side in W/m^2, is the exitance; over pi, the radiance.
size, max_thickness_mm  as for BaseLut
tolerance               largest error in SkinLutReport's norm, 1e-6 to 0.1; the streams are chosen to meet it
threads                 0: one for each processor
Raises ValueError naming what is wrong.)");
    m.def(
        "base_lut_report",
        [](const DescribedTissue& self, std::int64_t size, double max_thickness_mm, double tolerance,
           int threads) {
            SkinLut result = base_lut_report(self.tissue, numpy::to_count(size, "size"), max_thickness_mm,
                                             tolerance, threads);
            return std::pair(std::move(result.lut), result.report);
        },
        "tissue"_a, "size"_a = default_lut_size, "max_thickness_mm"_a = default_max_thickness_mm,
        "tolerance"_a = default_lut_tolerance, "threads"_a = 0, Released(),
        "base_lut with its report: (BaseLut, SkinLutReport).");
    m.def(
        "reference_lut",
        [](const DescribedTissue& self, std::int64_t size, double max_thickness_mm, int streams,
           int threads) {
            return reference_lut(self.tissue, numpy::to_count(size, "size"), max_thickness_mm, streams,
                                 threads);
        },
        "tissue"_a, "size"_a = default_lut_size, "max_thickness_mm"_a = default_max_thickness_mm,
        "streams"_a = 64, "threads"_a = 0, Released(),
        "base_lut with as many streams as the caller says, as for slab: what base_lut is measured by.");
    m.def("lut_error", &lut_error, "lut"_a, "exact"_a, Released(),
          "The error of one BaseLut against another of the same size, in SkinLutReport's norm.");
}

}  // namespace

void bind_spectrum(py::module_& m);

void bind_tissue(py::module_& m) {
    bind_tissue_class(m);
    m.def(
        "skin_angular_weight",
        [](const DescribedTissue& tissue, double thickness_mm, int streams) {
            return skin_angular_weight(tissue.tissue, thickness_mm, streams);
        },
        "tissue"_a, "thickness_mm"_a = 4.0, "streams"_a = 16, py::call_guard<py::gil_scoped_release>(),
        R"(How the light on a skin's far side enters by its angle, solved: an AngularWeight.

It hardly depends on the thickness (mm, above 0); one typical of the object will do. streams as for slab.)");
    m.def("transmittance", &transmittance_of_arrays, "tissue"_a, "thickness_mm"_a, "wavelength_nm"_a,
          "incidence"_a = "diffuse", "streams"_a = 16, "threads"_a = 0,
          R"(Total transmittance of skin in air, shape (n_thickness, n_wavelength), in [0, 1].

thickness_mm   (n,) epidermes included, 0 or more; thinner skin than its two epidermes is epidermis alone
wavelength_nm  (m,) 380 to 780
incidence      "diffuse", "normal" or the cosine mu0 in (0, 1]
streams        as for slab
threads        that divide the wavelengths; 0: one for each processor
Falls with thickness. Raises ValueError naming what is wrong.)");
    m.def(
        "skin_layers",
        [](const DescribedTissue& self, double total_thickness_mm, double wavelength_nm) {
            return skin_layers(self.tissue, total_thickness_mm, wavelength_nm);
        },
        "tissue"_a, "total_thickness_mm"_a, "wavelength_nm"_a,
        "The layers of skin, epidermis / inner layer / epidermis, for slab; 380 to 780 nm.");
    bind_skin_lut(m);
    bind_spectrum(m);
}
