# SPDX-License-Identifier: GPL-3.0-or-later
"""Which nodes a skin group has, and how it gets others: for plain rows, for light per pixel, for tiles."""

from typing import NamedTuple

import bpy

from ..errors import core
from ..table.lut_layout import Layout
from .lut_image import TILE_NODES_PROPERTY, TILES_ONLY, group_layout
from .skin_group import build_plain, build_tiles
from .surface_group import build_surface
from .tile_image import TILES


class GroupNodes(NamedTuple):
    """What a skin group's nodes read."""

    layout: Layout | None = None  #: of rows that light per pixel; None: plain rows
    tiles: bool = False
    rows: bool = True  #: False: tiles only, and no layout


def nodes_of(group: bpy.types.NodeTree) -> GroupNodes:
    """The nodes that a group has."""
    tiles = group.get(TILE_NODES_PROPERTY)
    return GroupNodes(group_layout(group), tiles is not None, tiles != TILES_ONLY)


def build_nodes(group: bpy.types.NodeTree, wanted: GroupNodes) -> None:
    """Rebuilds a group's nodes; images are kept, those of tiles are made if there are none. Not while rendering."""
    if not wanted.rows:
        build_tiles(group)
    elif wanted.layout is None:
        build_plain(group, wanted.tiles)
    else:
        build_surface(group, wanted.layout, wanted.tiles)
    if wanted.tiles:
        TILES.ensure(group, core().FaceTiles.WIDTH, 1)
