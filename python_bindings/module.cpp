#include <pybind11/pybind11.h>

void bind_core(pybind11::module_& m);
void bind_light(pybind11::module_& m);
void bind_slab(pybind11::module_& m);
void bind_tissue(pybind11::module_& m);
void bind_irradiance(pybind11::module_& m);
void bind_rig(pybind11::module_& m);
void bind_povray(pybind11::module_& m);
void bind_surface_lighting(pybind11::module_& m);
void bind_face_tiles(pybind11::module_& m);

PYBIND11_MODULE(_core, m) {
    m.doc() = "Light weights, lookup tables, recoloring and skin optics. mm, W, nm, radians, linear Rec.709.";
    m.attr("__version__") = SKINGLOW_VERSION;
    // A function's signature names the classes bound before it.
    bind_light(m);
    bind_core(m);
    bind_irradiance(m);
    bind_slab(m);
    bind_tissue(m);
    bind_rig(m);
    bind_surface_lighting(m);
    bind_povray(m);
    bind_face_tiles(m);
}
