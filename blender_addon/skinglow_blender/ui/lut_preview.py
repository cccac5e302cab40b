# SPDX-License-Identifier: GPL-3.0-or-later
"""A thumbnail of a skin's lookup for the panel, thin skin on the left; values above 1 are clipped."""

import bpy
import bpy.utils.previews
import numpy as np
from mathutils import Color

from ..commands.skin import lut
from ..errors import SkinError
from ..session import SESSION

#: Blender draws all icons as squares.
WIDTH, HEIGHT = 64, 64
_previews: bpy.utils.previews.ImagePreviewCollection | None = None


def icon_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> int:
    """The icon ID of a skin's lookup, redrawn only when that changed; 0 if there is none."""
    group = obj.skinglow.group
    atlas = SESSION.atlases.get((group.name_full, depsgraph.mode)) if group is not None else None
    signature = atlas.signatures.get(obj.name_full) if atlas is not None else None
    if signature is None or _previews is None:
        return 0
    preview = _previews.get(obj.name_full) or _previews.new(obj.name_full)
    if SESSION.thumbnails.get(obj.name_full) != signature:
        try:
            table = lut(obj, depsgraph)
        except SkinError:
            return 0
        columns = table[np.arange(WIDTH) * len(table) // WIDTH].clip(0.0, 1.0)
        pixels = np.ones((HEIGHT, WIDTH, 4), np.float32)
        pixels[:, :, :3] = [
            Color(color).from_rec709_linear_to_scene_linear().from_scene_linear_to_srgb()[:]
            for color in columns.tolist()
        ]
        preview.image_size = (WIDTH, HEIGHT)
        preview.image_pixels_float.foreach_set(pixels.ravel())
        SESSION.thumbnails[obj.name_full] = signature
    return preview.icon_id


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
