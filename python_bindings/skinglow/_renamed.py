"""Names of earlier versions, which go on working with a DeprecationWarning."""

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])

RENAMED = {
    "LightTree": "PreparedRig",
    "VisibleShare": "VisibleFraction",
    "black_body_colour": "black_body_color",
    "irradiance": "object_irradiance",
    "irradiances": "object_irradiance_by_light",
    "povray_scene": "povray_files",
    "recolour": "recolor",
    "spectral_colour": "spectral_color",
    "unnormalised_power_factor": "unnormalized_power_factor",
}

REMOVED = {
    "base_lut_by_plan": "reference_lut takes streams, and solves every thickness and wavelength",
    "diffusion_transmittance": "transmittance solves it properly; studies/accuracy/diffusion.py has the formula",
}


def __getattr__(name: str) -> object:
    """The public object that a former name stands for now: for use as `skinglow.__getattr__`."""
    import skinglow

    if name in REMOVED:
        raise AttributeError(f"skinglow.{name} is gone: {REMOVED[name]}")
    if name not in RENAMED:
        raise AttributeError(f"module 'skinglow' has no attribute {name!r}")
    warnings.warn(f"skinglow.{name} is now skinglow.{RENAMED[name]}", DeprecationWarning, stacklevel=2)
    return getattr(skinglow, RENAMED[name])


def renamed_keywords(**new_names: str) -> Callable[[Function], Function]:
    """A decorator by which a function also takes keywords by their former names: `@renamed_keywords(old="new")`.

    To type checkers it stays what it is.
    """

    def decorate(function: Function) -> Function:
        @functools.wraps(function)
        def call(*arguments: Any, **keywords: Any) -> Any:  # noqa: ANN401
            for old in new_names.keys() & keywords.keys():
                new = new_names[old]
                if new in keywords:
                    raise TypeError(f"{function.__name__}() got both {new!r} and its former name {old!r}")
                warnings.warn(f"{function.__name__}: {old} is now {new}", DeprecationWarning, stacklevel=2)
                keywords[new] = keywords.pop(old)
            return function(*arguments, **keywords)

        return cast(Function, call)

    return decorate
