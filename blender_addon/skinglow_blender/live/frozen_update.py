# SPDX-License-Identifier: GPL-3.0-or-later
"""What an update does for frozen skins: nothing but keep their property, and notice what they no longer follow."""

import hashlib

import bpy

from ..read.measured_size import scale_since_measured
from ..read.scene_reading import ROW_PROPERTY, SceneReading, Skin
from ..show.frozen import MARK_LENGTH, frozen_row, frozen_tiles, holds_row
from ..show.tile_image import DARK, TILE_PROPERTY, set_tile_property
from ..table.skin_tables import signature_of


def mark_of(obj: bpy.types.Object, skin: Skin, reading: SceneReading) -> str:
    """A short digest of everything that a skin's light depends on."""
    inputs = (
        signature_of(skin, reading.lights, reading.world),
        skin.strength,
        scale_since_measured(obj.data, skin.world_size),
    )
    return hashlib.sha256(repr(inputs).encode()).hexdigest()[:MARK_LENGTH]


def follow_frozen(
    group: bpy.types.NodeTree, members: list[tuple[bpy.types.Object, Skin]], faults: dict[str, str]
) -> None:
    """Gives the skins of a frozen group the property by which their materials read their rows."""
    for obj, skin in members:
        row = obj.skinglow.row
        if not holds_row(group, row):
            faults[skin.key] = (
                f"{skin.name}: its material is frozen, but not with this object, which therefore does not glow: "
                "unfreeze the skins of this material"
            )
        wanted = frozen_row(group, row)
        if tuple(obj.get(ROW_PROPERTY, ())) != wanted:
            obj[ROW_PROPERTY] = wanted
            obj.update_tag(refresh={"OBJECT"})
        tiles = frozen_tiles(group, row)
        if tiles != DARK or TILE_PROPERTY in obj:
            set_tile_property(obj, tiles)
