# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what is known of the light through shapes into the tiles that show it."""

from collections.abc import Iterable, Mapping

import bpy

from ..errors import SkinError
from ..identity import key_of
from ..read import working_space
from ..session import SESSION
from ..show.tile_image import place_tiles, show_tiles, tile_atlas
from ..thickness.thickness_attribute import THICKNESS_ATTRIBUTE
from ..thickness.tile_attribute import TILES_OF_MESH, ensure_tiles, is_current, is_of_this_mesh
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
            # Thickness stays where it was written with other light.
            before = atlas.written(key, rows[key])
            has_alpha = before is not None and before.tiles is each.tiles
            pixels = atlas.rows_for(key, rows[key], each.tiles.rows, each)
            each.tiles.draw(working_space.from_rec709(each.radiance), pixels, alpha=not has_alpha)
        show_tiles(obj, atlas, rows[key])
    atlas.look_for_loss(group)
    if atlas.is_dirty:
        atlas.write(group)
    if mode == "RENDER" or not SESSION.rendering:
        atlas.show(group)


def hide_tiles(obj: bpy.types.Object) -> None:
    """Has the material of an object read its row again."""
    show_tiles(obj, None)


def store_missing_tiles(skins: Iterable[bpy.types.Object]) -> bool:
    """Gives tiles to the meshes of those skins that became lit through their shape, or whose thickness was stored anew.

    Those whose faces were edited are left to Repair, which measures them too. Returns whether any was given some.
    """
    skins = list(skins)
    stored = any([_store(obj) for obj in skins])
    # In Edit Mode they are stored when it is left.
    SESSION.may_lack_tiles = any(obj.mode == "EDIT" for obj in skins)
    return stored


def _store(obj: bpy.types.Object) -> bool:
    settings, mesh = obj.skinglow, obj.data
    if settings.mode != "PHYSICAL" or settings.weights != "SHAPE" or mesh.library is not None or obj.mode == "EDIT":
        return False
    if is_current(mesh) or THICKNESS_ATTRIBUTE not in mesh.attributes:
        return False
    if TILES_OF_MESH in mesh and not is_of_this_mesh(mesh):
        return False
    try:
        return ensure_tiles(obj, bpy.context.scene)
    except (SkinError, ValueError) as error:
        SESSION.faults[key_of(obj)] = f"{obj.name}: {error}"
        return False
