# SPDX-License-Identifier: GPL-3.0-or-later
"""The lookups of all skins of a node group in one image, one row each (image_pairs.py)."""

from typing import Any

import bpy
import numpy as np

from ..table.lut_layout import LAYOUT_PROPERTY, Layout
from .image_pairs import GroupImages, PairContents, read_pixels
from .inner_groups import SURFACE_NODE, TEXEL_NODE

#: The image nodes of plain rows before version 4.
EARLIER_NODES = ("LUT below", "LUT above")
#: Custom property that marks our node groups, and the version of their nodes (file_upgrade.py).
GROUP_PROPERTY = "skinglow"
#: Custom property of a group that shows an image sequence (frozen.py), and the name of the image node that it adds.
FROZEN_PROPERTY = "skinglow_frozen"
HEADER_NODE = "LUT header"
#: Custom property of a group with nodes for tiles (tile_image.py): whether it has those of the lookup too.
TILE_NODES_PROPERTY = "skinglow_tile_nodes"
TILES_ONLY, TILES_AND_ROWS = "only", "and rows"
GROUP_VERSION = 4


def is_skin_group(tree: bpy.types.NodeTree | None) -> bool:
    """Whether a node tree is a skin node group."""
    return tree is not None and GROUP_PROPERTY in tree and bool(image_nodes(tree))


def image_nodes(group: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """The nodes through which a group reads the image of its rows; empty if they were deleted."""
    group_nodes = group.nodes
    # A look for a node by name goes through all of them, but this one is among the first.
    texel = group_nodes.get(TEXEL_NODE)
    tree = texel.node_tree if texel is not None else None
    found = [tree.nodes.get(SURFACE_NODE)] if tree is not None else list(map(group_nodes.get, EARLIER_NODES))
    if FROZEN_PROPERTY in group:
        found.append(group_nodes.get(HEADER_NODE))
    return [node for node in found if node is not None]


def group_layout(group: bpy.types.NodeTree) -> Layout | None:
    """The layout that a skin group's nodes read; None for plain rows."""
    stored = group.get(LAYOUT_PROPERTY)
    return Layout(stored[0], stored[1], stored[2], bool(stored[3])) if stored is not None else None


def skin_groups() -> list[bpy.types.NodeTree]:
    """All skin node groups of the file."""
    return [tree for tree in bpy.data.node_groups if is_skin_group(tree)]


ROWS = GroupImages("LUT", image_nodes)
shown_image, show_image, images_of, image_pair = ROWS.shown, ROWS.show, ROWS.all_of, ROWS.pair
has_room, ensure_images, renew_images, remove_images = ROWS.has_room, ROWS.ensure, ROWS.renew, ROWS.remove


class Atlas(PairContents):
    """The rows of one node group's images for one depsgraph mode."""

    def __init__(self, group: bpy.types.NodeTree, mode: str) -> None:
        super().__init__(ROWS, group, mode)
        self.layout = group_layout(group)
        self.pixels[:, :, 3] = 1.0
        self.signatures: dict[str, tuple] = {}
        self.rows: dict[str, int] = {}
        self._written: dict[str, object] = {}
        self.tables: dict[str, Any] = {}  #: skin_tables.Table by skin

    def fits(self, group: bpy.types.NodeTree, images: list[bpy.types.Image] | None = None) -> bool:
        """Whether group and images, their size and layout, and the file's working space are those of this atlas."""
        return super().fits(group, images) and self.layout == group_layout(group)

    def holds(self, key: str, row: int, table: object) -> bool:
        """Whether a skin's row holds exactly this table."""
        return self.rows.get(key) == row and self._written.get(key) is table

    def put(self, key: str, row: int, table: object, texels: np.ndarray) -> None:
        """Copies the texels (n, 4) of a skin's table into its row."""
        self.pixels[row, : len(texels)] = texels
        self.rows[key], self._written[key] = row, table
        self.is_dirty = True


def read_row(image: bpy.types.Image, row: int) -> np.ndarray:
    """A row's texels, (width, 4) float32, unconverted."""
    return read_pixels(image)[row].copy()
