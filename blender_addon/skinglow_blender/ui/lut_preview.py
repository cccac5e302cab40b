# SPDX-License-Identifier: GPL-3.0-or-later
"""A thumbnail of a skin's lookup: thin skin on the left, up to where it is dark; values above 1 are clipped."""

import bpy
import bpy.utils.previews
import numpy as np
from mathutils import Color

from ..commands.skin import lut
from ..errors import SkinError, core
from ..identity import key_of
from ..session import SESSION

#: Blender draws all icons as squares.
WIDTH, HEIGHT = 64, 64
_previews: bpy.utils.previews.ImagePreviewCollection | None = None


def icon_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[int, float]:
    """The icon ID of a skin's lookup, redrawn only when that changed, and the thickness at its right end, mm.

    (0, 0) if there is none.
    """
    group = obj.skinglow.group
    atlas = SESSION.atlases.get((key_of(group), depsgraph.mode)) if group is not None else None
    signature = atlas.signatures.get(key_of(obj)) if atlas is not None else None
    if signature is None or _previews is None:
        return 0, 0.0
    preview = _previews.get(key_of(obj)) or _previews.new(key_of(obj))
    drawn = SESSION.thumbnails.get(key_of(obj))
    if drawn is None or drawn[0] != signature:
        try:
            table = lut(obj, depsgraph)
        except SkinError:
            return 0, 0.0
        entries = core().visible_entries(table)
        columns = table[np.arange(WIDTH) * entries // WIDTH].clip(0.0, 1.0)
        pixels = np.ones((HEIGHT, WIDTH, 4), np.float32)
        pixels[:, :, :3] = [
            Color(color).from_rec709_linear_to_scene_linear().from_scene_linear_to_srgb()[:]
            for color in columns.tolist()
        ]
        preview.image_size = (WIDTH, HEIGHT)
        preview.image_pixels_float.foreach_set(pixels.ravel())
        drawn = SESSION.thumbnails[key_of(obj)] = (signature, obj.skinglow.max_thickness_mm * entries / len(table))
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
