# SPDX-License-Identifier: GPL-3.0-or-later
"""A thumbnail of a skin's lookup: thin skin on the left, up to where it is dark; values above 1 are clipped."""

import bpy
import numpy as np
from mathutils import Color

from ..commands.skin import lut
from ..errors import core
from ..identity import key_of
from ..session import SESSION
from .thumbnails import SIZE, thumbnail


def icon_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[int, float]:
    """The icon ID of a skin's lookup, and the thickness at its right end, mm; (0, 0) if there is none."""
    group = obj.skinglow.group
    atlas = SESSION.atlases.get((key_of(group), depsgraph.mode)) if group is not None else None
    signature = atlas.signatures.get(key_of(obj)) if atlas is not None else None
    if signature is None:
        return 0, 0.0
    return thumbnail(f"lookup {key_of(obj)}", signature, lambda: _pixels(obj, depsgraph))


def _pixels(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[np.ndarray, float]:
    table = lut(obj, depsgraph)
    entries = core().visible_entries(table)
    columns = table[np.arange(SIZE) * entries // SIZE].clip(0.0, 1.0)
    pixels = np.ones((SIZE, SIZE, 4), np.float32)
    pixels[:, :, :3] = [
        Color(color).from_rec709_linear_to_scene_linear().from_scene_linear_to_srgb()[:] for color in columns.tolist()
    ]
    return pixels, obj.skinglow.max_thickness_mm * entries / len(table)
