#pragma once

#include <pybind11/pybind11.h>

namespace skinglow {

/// Each adds its part to the module with Embree.
void bind_thickness(pybind11::module_& m);
void bind_occlusion(pybind11::module_& m);
void bind_shape(pybind11::module_& m);

}  // namespace skinglow
