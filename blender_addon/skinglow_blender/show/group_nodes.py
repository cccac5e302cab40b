# SPDX-License-Identifier: GPL-3.0-or-later
"""Which nodes a skin group has, and how it gets others: for plain rows, for light per pixel, for tiles."""

from typing import NamedTuple

import bpy

from ..table.lut_layout import Layout
from .image_pairs import SLOTS
from .inner_groups import clear, has_inner_groups
from .lut_image import TILE_NODES_PROPERTY, TILES_ONLY, group_layout
from .skin_group import build_plain, build_tiles, image_widths
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
    """Rebuilds a group's nodes; inner groups and images are kept. Not while rendering."""
    if not wanted.rows:
        build_tiles(group)
    elif wanted.layout is None:
        build_plain(group, wanted.tiles)
    else:
        build_surface(group, wanted.layout, wanted.tiles)
    if not wanted.tiles:
        TILES.shrink(group)


def make_whole(group: bpy.types.NodeTree) -> None:
    """Makes the inner groups and images that a group lacks or has of a library. By operators only: inner_groups.py."""
    if group.library is not None:
        return
    images = {kind: kind.all_of(group) for kind, _width in image_widths()}
    is_made_local = any(image.library is not None for each in images.values() for image in each)
    wanted, is_whole = nodes_of(group), has_inner_groups(group)
    if is_made_local:
        clear(group, keep=False)
    if is_made_local or not is_whole:
        build_nodes(group, wanted)
    for kind, width in image_widths():
        if is_made_local or len(images[kind]) != len(SLOTS):
            kind.renew(group, width, 1)
