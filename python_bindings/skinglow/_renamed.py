"""Names of earlier versions, which go on working with a DeprecationWarning."""

import warnings

RENAMED = {
    "black_body_colour": "black_body_color",
    "recolour": "recolor",
    "spectral_colour": "spectral_color",
    "unnormalised_power_factor": "unnormalized_power_factor",
}


def __getattr__(name: str) -> object:
    """The public object that a former name stands for now: for use as `skinglow.__getattr__`."""
    import skinglow

    if name not in RENAMED:
        raise AttributeError(f"module 'skinglow' has no attribute {name!r}")
    warnings.warn(f"skinglow.{name} is now skinglow.{RENAMED[name]}", DeprecationWarning, stacklevel=2)
    return getattr(skinglow, RENAMED[name])
