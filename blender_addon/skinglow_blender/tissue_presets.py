# SPDX-License-Identifier: GPL-3.0-or-later
"""The named skins that set the sliders of a skin."""

from functools import lru_cache

import bpy
import numpy as np

from .errors import core

#: The core's named skins (skinglow.TISSUE_PRESETS).
PRESETS = (
    ("CUSTOM", "Custom", "Current values of the sliders"),
    ("VERY_LIGHT", "Very Light", "Very little melanin"),
    ("LIGHT", "Light", "Light skin, like the head in the paper"),
    ("MEDIUM", "Medium", "Medium pigmentation"),
    ("DARK", "Dark", "Dark skin"),
    ("VERY_DARK", "Very Dark", "Very much melanin"),
    ("PALE", "Pale", "Light skin with little blood"),
    ("FLUSHED", "Flushed", "Light skin with much blood, rich in oxygen"),
    ("CYANOTIC", "Cyanotic", "Light skin with much blood, poor in oxygen"),
    ("EAR", "Ear", "Thin skin over cartilage"),
)
#: The parameters of skinglow.Tissue that are sliders here.
TISSUE_SLIDERS = (
    "melanin_fraction",
    "blood_fraction",
    "oxygen_saturation",
    "epidermal_thickness_mm",
    "scattering_scale",
    "refractive_index",
    "cartilage_fraction",
)


@lru_cache(maxsize=1)
def _tissues() -> dict[str, tuple[float, ...]]:
    """The sliders of each preset, in single precision as Blender stores them."""
    presets = core().TISSUE_PRESETS
    return {
        name: tuple(float(np.float32(getattr(presets[name.lower()], slider))) for slider in TISSUE_SLIDERS)
        for name, _label, _description in PRESETS[1:]
    }


def preset_of_sliders(settings: bpy.types.PropertyGroup) -> int:
    """The preset is not stored: it is the one whose values the sliders show, also where they are keyed or driven."""
    shown = tuple(getattr(settings, slider) for slider in TISSUE_SLIDERS)
    return next((i for i, tissue in enumerate(_tissues().values(), 1) if tissue == shown), 0)


def set_sliders(settings: bpy.types.PropertyGroup, number: int) -> None:
    if number > 0:
        for slider, value in zip(TISSUE_SLIDERS, _tissues()[PRESETS[number][0]], strict=True):
            setattr(settings, slider, value)
