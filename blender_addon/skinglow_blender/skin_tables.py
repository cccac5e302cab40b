# SPDX-License-Identifier: GPL-3.0-or-later
"""From settings and lamps to the table that a skin shows. All computing is the core's."""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from .base_image import base_of_image, brightness
from .errors import SkinError, core
from .scene_lights import Lamp, make_light
from .scene_reading import Skin
from .skin_settings import TISSUE_SLIDERS


class Table(NamedTuple):
    """A skin's lookup: one linear Rec.709 colour per entry, and where a thickness finds its entry."""

    colors: np.ndarray  #: (size, 3) float64
    texel_mapping: tuple[float, float]  #: as skinglow.BaseLut.texel_mapping
    weight: tuple[float, float, float] | None  #: what the base was multiplied by; None in mode `existing`


def signature_of(skin: Skin, lamps: list[Lamp]) -> tuple:
    """All that a skin's table depends on: it is computed again only when this changes."""
    if skin.mode == "EXISTING":
        return (skin.mode, skin.base)
    lights = tuple(lamp.signature for lamp in lamps_of(skin, lamps))
    if skin.mode == "PAPER":
        return (skin.mode, skin.base, skin.blood_weight, skin.attenuation, skin.point, lights)
    return (skin.mode, skin.base, skin.point, lights)


def lamps_of(skin: Skin, lamps: list[Lamp]) -> list[Lamp]:
    """The lamps that reach this skin, as far as it sees them."""
    return [lamp.seen_by(skin.key) for lamp in lamps if not lamp.left_out and lamp.lights(skin.name)]


def compute_table(skin: Skin, lamps: list[Lamp]) -> Table:
    """Computes a skin's lookup. Raises SkinError or ValueError, in words, where it cannot."""
    sg = core()
    base = base_lut(skin.base)
    if skin.mode == "EXISTING":
        return Table(sg.six_gaussian_lookup(base.size, base.max_thickness_mm), base.texel_mapping, None)
    lights = [make_light(lamp) for lamp in lamps_of(skin, lamps)]
    if skin.mode == "PAPER":
        weight = np.add(skin.blood_weight, sg.light_weight(lights, skin.point, skin.attenuation))
    else:
        # Light that leaves diffusely: the radiance is the flux per area over pi.
        weight = sg.irradiance(lights, skin.point) / math.pi
    colors = sg.recolour(base, weight)
    if np.abs(colors).max() > np.finfo(np.float32).max:
        raise SkinError(f"{skin.name}: the lookup is brighter than an image can hold; turn the lights down")
    return Table(colors, base.texel_mapping, tuple(float(w) for w in weight))


def base_lut(key: tuple) -> Any:  # noqa: ANN401  a skinglow.BaseLut
    """The base lookup that a skin's settings ask for."""
    return base_of_image(key) if key[0] == "IMAGE" else _computed_base(key)


@lru_cache(maxsize=64)
def _computed_base(key: tuple) -> Any:  # noqa: ANN401
    sg = core()
    kind, size, max_thickness_mm = key[:3]
    if kind == "BUILTIN":
        return sg.six_gaussian_base(size, max_thickness_mm)
    tissue = sg.Tissue(**dict(zip(TISSUE_SLIDERS, key[3], strict=True)))
    base = sg.base_lut(tissue, size, max_thickness_mm)
    if kind == "TISSUE":
        return base
    return sg.BaseLut(brightness(sg.recolour(base, (1.0, 1.0, 1.0))), max_thickness_mm)
