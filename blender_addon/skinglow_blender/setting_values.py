# SPDX-License-Identifier: GPL-3.0-or-later
"""Setting values of a skin from scripts, and reading them as they were typed."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

import bpy
import numpy as np

from .setting_choices import ALIASES
from .skin_settings import SETTING_NAMES, SkinSettings


@contextmanager
def applied(settings: SkinSettings, values: dict[str, Any]) -> Iterator[None]:
    """Context manager that sets properties by name, and sets all of them back if anything in it fails.

    Raises ValueError naming the setting and the allowed values.
    """
    before = {name: _value(settings, name) for name in SETTING_NAMES}
    try:
        # The preset first: it sets the sliders, which may be given too.
        for name, value in sorted(values.items(), key=lambda item: item[0] != "preset"):
            _apply(settings, name, value)
        yield
    except BaseException:
        for name in SETTING_NAMES:
            if name != "preset" and _value(settings, name) != before[name]:
                setattr(settings, name, before[name])
        raise


def _value(settings: SkinSettings, name: str) -> Any:  # noqa: ANN401
    value = getattr(settings, name)
    return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value


def _apply(settings: SkinSettings, name: str, value: Any) -> None:  # noqa: ANN401
    if name not in SETTING_NAMES:
        raise ValueError(f"make_skin has no setting '{name}'; it has: {', '.join(SETTING_NAMES)}")
    rna = settings.bl_rna.properties[name]
    upper = rna.type == "ENUM" and isinstance(value, str)
    given = value
    try:
        if rna.type in ("INT", "FLOAT"):
            _check_range(rna, value)
        if upper:
            value = _choice(rna, ALIASES.get(name, {}).get(value.upper(), value.upper()))
        setattr(settings, name, value)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"make_skin: {name} = {given!r} is not allowed: {error}") from error


def _choice(rna: bpy.types.Property, value: str) -> str:
    """The value, if it is one; choices that are made as they are shown are left to Blender."""
    names = [item.identifier for item in rna.enum_items]
    if names and value not in names:
        raise ValueError(f"it has to be one of {', '.join(names)}")
    return value


def _check_range(rna: bpy.types.Property, value: Any) -> None:  # noqa: ANN401
    """Blender clamps numbers without a word and accepts what is not finite."""
    for number in np.ravel(np.asarray(value, np.float64)):
        if not rna.hard_min <= number <= rna.hard_max:
            raise ValueError(f"it has to be from {rna.hard_min:g} to {rna.hard_max:g}")


@lru_cache(maxsize=4096)
def as_typed(value: float) -> float:
    """The double that the user typed into a single-precision property: 1.8 where Blender stores 1.7999999523.

    That is the shortest decimal number that rounds to the stored value; so Eq. 1 is exact to the last digit.
    """
    return float(str(np.float32(value)))
