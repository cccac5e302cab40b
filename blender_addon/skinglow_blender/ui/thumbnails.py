# SPDX-License-Identifier: GPL-3.0-or-later
"""Small pictures in panels, drawn anew only when what they show changed. Blender draws all icons as squares."""

from collections.abc import Callable

import bpy.utils.previews
import numpy as np

from ..errors import SkinError
from ..session import SESSION

#: Width and height, pixels.
SIZE = 64
_previews: bpy.utils.previews.ImagePreviewCollection | None = None


def thumbnail(key: str, shows: tuple, draw: Callable[[], tuple[np.ndarray, float]]) -> tuple[int, float]:
    """An icon's ID, and the thickness at its right end, mm; (0, 0) if it cannot be drawn.

    key    of the picture
    shows  what it depends on
    draw   returns its pixels (SIZE, SIZE, 4), sRGB, bottom row first, and that thickness; may raise SkinError
    """
    if _previews is None:
        return 0, 0.0
    preview = _previews.get(key) or _previews.new(key)
    drawn = SESSION.thumbnails.get(key)
    if drawn is None or drawn[0] != shows:
        try:
            pixels, limit_mm = draw()
        except SkinError:
            return 0, 0.0
        preview.image_size = (SIZE, SIZE)
        preview.image_pixels_float.foreach_set(pixels.ravel())
        drawn = SESSION.thumbnails[key] = (shows, limit_mm)
    return preview.icon_id, drawn[1]


def register() -> None:
    """Creates the collection of thumbnails."""
    global _previews
    _previews = bpy.utils.previews.new()


def unregister() -> None:
    """Frees the thumbnails."""
    global _previews
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
    _previews = None
    SESSION.thumbnails.clear()
