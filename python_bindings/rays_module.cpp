#include <pybind11/pybind11.h>

#include "bind_rays.h"

PYBIND11_MODULE(_rays, m) {
    m.doc() = "What rays find out about meshes (Embree). Import it through skinglow.";
    // pybind11 keeps one table of exceptions for modules that share their types, and the module loaded first, _core,
    // compiles it in. In portable packages each module links a C++ runtime of its own, and code in _core cannot catch what
    // is thrown here: the same table, compiled in here, goes first.
    pybind11::register_local_exception_translator(pybind11::detail::translate_exception);
    pybind11::module_::import("skinglow._core");  // knows the lights
    skinglow::bind_thickness(m);
    skinglow::bind_occlusion(m);
    skinglow::bind_shape(m);
}
