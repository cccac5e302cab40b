# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of how the thickness of a skin is distributed, for the panel: thin on the left."""

import bpy
import numpy as np

from ..errors import core
from ..identity import key_of
from ..thickness.thickness_attribute import SUMMARY
from .thumbnails import SIZE, thumbnail

BACKGROUND = (0.12, 0.12, 0.12, 1.0)


def histogram_icon(mesh: bpy.types.Mesh) -> int:
    """The icon ID of a mesh's histogram; 0 if there is none."""
    summary = mesh.get(SUMMARY)
    if summary is None:
        return 0
    numbers = tuple(summary)
    limit_mm = numbers[0]
    return thumbnail(f"histogram {key_of(mesh)}", numbers, lambda: (histogram_pixels(limit_mm, numbers[5:]), limit_mm))[
        0
    ]


def histogram_pixels(limit_mm: float, fractions: tuple[float, ...]) -> np.ndarray:
    """Bars (SIZE, SIZE, 4), sRGB, bottom row first; the highest as high as the picture."""
    columns = np.arange(SIZE) * len(fractions) // SIZE
    heights = np.asarray(fractions)[columns] / max(max(fractions), 1e-9) * SIZE
    colors = core().thickness_colors((columns + 0.5) * limit_mm / len(fractions), limit_mm)
    pixels = np.empty((SIZE, SIZE, 4), np.float32)
    pixels[:] = BACKGROUND
    filled = np.arange(SIZE)[:, None] < np.ceil(heights)
    pixels[:, :, :3] = np.where(filled[:, :, None], colors, pixels[:, :, :3])
    return pixels
