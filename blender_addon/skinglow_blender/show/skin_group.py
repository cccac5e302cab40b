# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that adds the transmitted light, looked up by thickness, to a surface (group_sockets.py).

Where the thickness is not known there is no light: what a modifier or an edit adds has no thickness, which reads as 0
and would otherwise pass for the thinnest skin.

The object's custom property provides its texels per mm, the width of a texel, the v coordinate of its row and its
strength; an object without the property has strength 0 and does not glow.

The two texels next to a thickness are read unfiltered and interpolated by nodes: EEVEE filters images with mip maps, in
which the rows of different skins bleed into each other, and with 8-bit weights.

A group whose skins are lit through their shape reads tiles instead (tile_group.py), or both, by what the object shows.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import bpy

from ..errors import core
from ..read.scene_reading import ROW_PROPERTY
from ..table.lut_layout import LAYOUT_PROPERTY
from ..thickness.thickness_attribute import KNOWN_ATTRIBUTE, MIN_KNOWN, THICKNESS_ATTRIBUTE
from .group_sockets import ensure_sockets
from .image_pairs import GroupImages
from .inner_groups import TEXEL_NODE, clear, inner_groups_of
from .lut_image import (
    GROUP_PROPERTY,
    GROUP_VERSION,
    ROWS,
    TILE_NODES_PROPERTY,
    TILES_AND_ROWS,
    TILES_ONLY,
)
from .node_building import NodeBuilder, Socket
from .tile_group import add_tiles
from .tile_image import TILES

GROUP_NAME = "Skinglow"


def new_group() -> bpy.types.NodeTree:
    """Creates a group with its sockets and images, for plain rows."""
    group = bpy.data.node_groups.new(GROUP_NAME, "ShaderNodeTree")
    group[GROUP_PROPERTY] = GROUP_VERSION
    build_plain(group)
    for kind, width in image_widths():
        kind.renew(group, width, 1)
    return group


def image_widths() -> tuple[tuple[GroupImages, int], ...]:
    """The kinds of images that every group has, and the width of each when it is new."""
    return (ROWS, 256), (TILES, core().FaceTiles.WIDTH)


class RowSockets:
    """The common inputs of all skin groups: the group's own sockets, thickness and the object's property."""

    def __init__(self, build: NodeBuilder) -> None:
        self.given = build.node("NodeGroupInput").outputs
        self.thickness, known = measured_thickness(build, self.given["Thickness"])
        row = _own_row(build)
        texels_per_mm, self.texel_width, self.row = build.split(row.outputs["Vector"])
        self.texel = build.math("MULTIPLY", self.thickness, texels_per_mm, label="Texel")
        self.light = Light(self.given, row.outputs["Alpha"], known)


class Light(NamedTuple):
    """What the light is multiplied by before it is added to the surface."""

    given: bpy.types.bpy_prop_collection  #: the group's own inputs
    strength: Socket  #: of the object
    known: Socket  #: 0 where there is nothing to show


class Texels:
    """Reads texels of the skin's row, through an inner group."""

    def __init__(self, build: NodeBuilder, row: RowSockets) -> None:
        self.build, self.row, self.inner = build, row, inner_groups_of(build.tree)[TEXEL_NODE]

    def _node(self, texel: Socket | float) -> bpy.types.Node:
        node = self.build.instance(self.inner, "Texel")
        for name, value in (("Texel", texel), ("Texel width", self.row.texel_width), ("Row", self.row.row)):
            self.build.set(node.inputs[name], value)
        return node

    def read(self, texel: int) -> tuple[Socket, Socket]:
        """Color and alpha of a fixed texel."""
        node = self._node(float(texel))
        return node.outputs["Color"], node.outputs["Alpha"]

    def read_at(self, texel: Socket) -> Socket:
        """Color of a texel that depends on the pixel."""
        return self._node(texel).outputs["Color"]


def _own_row(build: NodeBuilder) -> bpy.types.Node:
    return build.attribute("OBJECT", ROW_PROPERTY, "Texels/mm, texel width, row, strength")


#: The mesh attributes that the nodes read, and the nodes' labels.
STORED = ((THICKNESS_ATTRIBUTE, "Thickness, mm"), (KNOWN_ATTRIBUTE, "Thickness known"))


def measured_thickness(build: NodeBuilder, given: Socket) -> tuple[Socket, Socket]:
    """The thickness in mm, and the share of it that is known.

    given  a thickness to use instead of the measured one where it is not negative
    """
    stored, known = (build.attribute("GEOMETRY", *named).outputs["Fac"] for named in STORED)
    # Between a known and an unknown vertex both are interpolated: their ratio is the known one's thickness.
    measured = build.math("DIVIDE", stored, build.math("MAXIMUM", known, MIN_KNOWN), label="Measured thickness, mm")
    is_measured = build.math("LESS_THAN", given, 0.0, label="No thickness is given")
    given = build.math("MAXIMUM", given, 0.0)
    return (
        build.math("MULTIPLY_ADD", measured, is_measured, given, label="Thickness, mm"),
        build.math("MAXIMUM", known, build.math("SUBTRACT", 1.0, is_measured), label="Known or given"),
    )


@contextmanager
def rebuilding(group: bpy.types.NodeTree) -> Iterator[None]:
    """Context manager in which a skin group gets other nodes, which show the images that the former ones did.

    Inner groups stay, but for those of an earlier version.
    """
    images = [(kind, kind.shown(group)) for kind in (ROWS, TILES)]
    clear(group, keep=group[GROUP_PROPERTY] == GROUP_VERSION)
    ensure_sockets(group)
    for name in (LAYOUT_PROPERTY, TILE_NODES_PROPERTY):
        group.pop(name, None)
    yield
    for kind, image in images:
        if image is not None:
            kind.show(group, image)


def build_plain(group: bpy.types.NodeTree, tiles: bool = False) -> None:
    """Rebuilds a skin group's nodes for plain rows, colors by thickness, and for tiles if wanted."""
    with rebuilding(group):
        build = NodeBuilder(group, -700.0, 200.0)
        row = RowSockets(build)
        texels = Texels(build, row)
        below, fraction = (build.math(operation, row.texel) for operation in ("FLOOR", "FRACT"))
        lower, upper = texels.read_at(below), texels.read_at(build.math("ADD", below, 1.0))
        step = build.vector("SUBTRACT", upper, lower)
        finish(build, build.vector("MULTIPLY_ADD", step, fraction, lower), row.light, tiles)


def build_tiles(group: bpy.types.NodeTree) -> None:
    """Rebuilds a skin group's nodes for tiles alone."""
    with rebuilding(group):
        build = NodeBuilder(group, -700.0, 200.0)
        given = build.node("NodeGroupInput").outputs
        strength = _own_row(build).outputs["Alpha"]
        found = add_tiles(build)
        shown = build.math("MULTIPLY", found.there, found.use)
        finish(build, found.color, Light(given, strength, shown))
        group[TILE_NODES_PROPERTY] = TILES_ONLY


def finish(build: NodeBuilder, color: Socket, light: Light, tiles: bool = False) -> None:
    """Adds the light to the surface; if `tiles`, that of the tiles for the objects that show them."""
    given, known = light.given, light.known
    if tiles:
        found = add_tiles(build)
        difference = build.vector("SUBTRACT", found.color, color)
        color = build.vector("MULTIPLY_ADD", difference, found.use, color, label="By tiles or by thickness")
        known = build.math("MULTIPLY_ADD", build.math("SUBTRACT", found.there, known), found.use, known)
        build.tree[TILE_NODES_PROPERTY] = TILES_AND_ROWS
    strength = build.math("MULTIPLY", light.strength, known, label="Strength where known")
    strength = build.math("MULTIPLY", strength, build.math("ADD", given["Mask"], 0.0, clamp=True))
    strength = build.math("MULTIPLY", strength, given["Strength"], label="Strength")
    tinted = build.vector("MULTIPLY", color, given["Tint"])
    shown = build.vector("SCALE", tinted, strength, label="Transmitted light")
    emission, add, out = (build.node(kind) for kind in ("ShaderNodeEmission", "ShaderNodeAddShader", "NodeGroupOutput"))
    build.set(emission.inputs["Color"], shown)
    build.set(add.inputs[0], given["Surface"])
    build.set(add.inputs[1], emission.outputs[0])
    build.set(out.inputs["Shader"], add.outputs[0])
    build.set(out.inputs["Light"], shown)
