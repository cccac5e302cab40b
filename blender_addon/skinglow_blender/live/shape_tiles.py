# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what is known of the light through shapes into the tiles that show it."""

from collections.abc import Mapping

import bpy

from ..identity import key_of
from ..read import working_space
from ..session import SESSION
from ..show.tile_image import place_tiles, show_tiles, tile_atlas
from .shape_update import Shown


def write_tiles(group: bpy.types.NodeTree, mode: str, shown: Mapping[bpy.types.Object, Shown]) -> None:
    """Puts the light of these skins of a group into the images of its tiles, and shows these."""
    if not shown:
        return
    rows = place_tiles(group, {obj: each.tiles.rows for obj, each in shown.items()})
    atlas = tile_atlas(group, mode)
    for obj, each in shown.items():
        key = key_of(obj)
        if not atlas.holds(key, rows[key], each):
            pixels = each.tiles.pixels(working_space.from_rec709(each.radiance))
            atlas.put(key, rows[key], each, pixels)
        show_tiles(obj, atlas, rows[key])
    if atlas.is_dirty:
        atlas.write(group)
    if mode == "RENDER" or not SESSION.rendering:
        atlas.show(group)


def hide_tiles(obj: bpy.types.Object) -> None:
    """Has the material of an object read its row again."""
    show_tiles(obj, None)
