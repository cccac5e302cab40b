#include <pybind11/pybind11.h>

void bind_core(pybind11::module_& m);
void bind_light(pybind11::module_& m);
void bind_slab(pybind11::module_& m);
void bind_tissue(pybind11::module_& m);
void bind_irradiance(pybind11::module_& m);
void bind_rig(pybind11::module_& m);
void bind_povray(pybind11::module_& m);
void bind_surface_lighting(pybind11::module_& m);

PYBIND11_MODULE(_core, m) {
    m.doc() =
        "Light weights, lookup tables, recolouring and skin optics. mm, W, nm, radians, linear Rec.709.";
    m.attr("__version__") = SKINGLOW_VERSION;
    bind_light(m);
    bind_core(m);
#ifdef SKINGLOW_BIND_SLAB
    bind_slab(m);
#endif
#ifdef SKINGLOW_BIND_TISSUE
    bind_tissue(m);
#endif
#ifdef SKINGLOW_BIND_IRRADIANCE
    bind_irradiance(m);
#endif
#ifdef SKINGLOW_BIND_RIG
    bind_rig(m);
#endif
    bind_surface_lighting(m);
#ifdef SKINGLOW_BIND_POVRAY
    bind_povray(m);
#endif
}
