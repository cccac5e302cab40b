"""How values go to other processes, and are copied: as the arguments that they are made of.

pybind11's classes are not pickled by themselves, so that multiprocessing, and copy.deepcopy of settings that hold a
light or a tissue, failed with a TypeError; and in protocols 0 and 1 its base class ends the process.
"""

import copyreg
from collections.abc import Callable
from types import ModuleType
from typing import Any, NoReturn

from skinglow import _core

_OF_LIGHT = ("kind", "color", "position", "direction", "power", "name", "visible")
_OF_LIGHTS_KIND = {
    "POINT": ("radius", "soft_falloff"),
    "SUN": ("sun_angle",),
    "SPOT": ("radius", "soft_falloff", "spot_angle", "spot_blend", "spot_cosine"),
    "AREA": ("area_shape", "size_x", "size_y", "tangent", "spread"),
}
_OF_LAYER = ("refractive_index", "absorption", "scattering", "anisotropy", "thickness")


def made(kind: Callable[..., Any], arguments: dict[str, Any]) -> Any:  # noqa: ANN401
    """What is called where a value is unpickled."""
    return kind(**arguments)


def preset(name: str) -> _core.Tissue:
    """The same, of a tissue with a description, which a new one would not have."""
    return _core.TISSUE_PRESETS[name]


def _fields(value: object, names: tuple[str, ...]) -> dict[str, Any]:
    return {name: getattr(value, name) for name in names}


def _reduced_light(light: _core.Light) -> tuple[Any, ...]:
    return made, (_core.Light, _fields(light, _OF_LIGHT + _OF_LIGHTS_KIND[light.kind]))


def _reduced_tissue(tissue: _core.Tissue) -> tuple[Any, ...]:
    for name, known in _core.TISSUE_PRESETS.items():
        if known == tissue and known.description == tissue.description:
            return preset, (name,)
    return made, (_core.Tissue, _fields(tissue, tuple(_core.TISSUE_PARAMETERS)))


def _reduced_lut(lut: _core.BaseLut) -> tuple[Any, ...]:
    return made, (_core.BaseLut, {"values": lut.matrices, "max_thickness_mm": lut.max_thickness_mm})


def _refused(value: object) -> NoReturn:
    raise TypeError(f"skinglow.{type(value).__name__} is not pickled or copied: give what it is made of, or its arrays")


def refuse_others(module: ModuleType) -> None:
    """Says so of all classes of a compiled module that are not told of."""
    for kind in vars(module).values():
        if isinstance(kind, type) and kind not in copyreg.dispatch_table and not issubclass(kind, Exception):
            copyreg.pickle(kind, _refused)


def register() -> None:
    """Tells pickle and copy of all of them."""
    copyreg.pickle(_core.Light, _reduced_light)
    copyreg.pickle(_core.Tissue, _reduced_tissue)
    copyreg.pickle(_core.BaseLut, _reduced_lut)
    copyreg.pickle(_core.Layer, lambda layer: (made, (_core.Layer, _fields(layer, _OF_LAYER))))
    copyreg.pickle(_core.PreparedRig, lambda rig: (made, (_core.PreparedRig, {"lights": rig.lights})))
    copyreg.pickle(_core.Environment, lambda world: (made, (_core.Environment, {"radiance": world.coefficients})))
    refuse_others(_core)
