# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of how the thickness of a skin is distributed, for the panel: thin on the left."""

import bpy
import bpy.utils.previews
import numpy as np

from ..errors import SkinError, core
from ..identity import key_of
from ..thickness.thickness_attribute import SUMMARY

#: Blender draws all icons as squares.
SIZE = 64
BACKGROUND = (0.12, 0.12, 0.12, 1.0)
_previews: bpy.utils.previews.ImagePreviewCollection | None = None
_drawn: dict[str, tuple] = {}


def histogram_icon(mesh: bpy.types.Mesh) -> int:
    """The icon ID of a mesh's histogram, redrawn only when that changed; 0 if there is none."""
    summary = mesh.get(SUMMARY)
    if summary is None or _previews is None:
        return 0
    numbers = tuple(summary)
    preview = _previews.get(key_of(mesh)) or _previews.new(key_of(mesh))
    if _drawn.get(key_of(mesh)) != numbers:
        try:
            pixels = histogram_pixels(numbers[0], numbers[5:])
        except SkinError:  # without the core
            return 0
        preview.image_size = (SIZE, SIZE)
        preview.image_pixels_float.foreach_set(pixels.ravel())
        _drawn[key_of(mesh)] = numbers
    return preview.icon_id


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


def register() -> None:
    """Creates the collection of pictures."""
    global _previews
    _previews = bpy.utils.previews.new()


def unregister() -> None:
    """Frees the pictures."""
    global _previews
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
    _previews = None
    _drawn.clear()
