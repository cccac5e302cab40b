#include <pybind11/pybind11.h>

#include "bind_rays.h"

PYBIND11_MODULE(_rays, m) {
    m.doc() = "What rays find out about meshes (Embree). Import it through skinglow.";
    pybind11::module_::import("skinglow._core");  // knows the lamps
    skinglow::bind_thickness(m);
    skinglow::bind_occlusion(m);
}
