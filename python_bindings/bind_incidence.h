#pragma once

#include <pybind11/pybind11.h>
#include <skinglow/slab.h>

#include <string>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace skinglow {

/// "normal", "diffuse", or a number: the cosine mu0 of an oblique beam. Whether the number is one is for the
/// solver to say.
inline Incidence to_incidence(pybind11::handle value) {
    constexpr const char* allowed = R"("normal", "diffuse" or a cosine above 0, at most 1)";
    if (pybind11::isinstance<pybind11::str>(value)) {
        const auto name = value.cast<std::string>();
        if (name == "normal") return Incidence::normal();
        if (name == "diffuse") return Incidence::diffuse();
        refuse_argument("incidence", "\"" + name + "\"", allowed);
    }
    if (PyNumber_Check(value.ptr()) == 0) {
        refuse_argument("incidence", pybind11::repr(value).cast<std::string>(), allowed);
    }
    return Incidence::oblique(numpy::to_number(value, "incidence"));
}

}  // namespace skinglow
