# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes that read light from tiles: four texels about a point of the skin, interpolated.

Each corner of the mesh stores its place in texels, which Blender interpolates over the face like a UV map; so the
coordinates follow every modifier that keeps attributes, and no place in space is involved.
"""

from typing import NamedTuple

import bpy

from ..thickness.tile_attribute import TEXEL_ATTRIBUTE
from .node_building import NodeBuilder, Socket, inner_group
from .tile_image import TILE_IMAGE_NODE, TILE_NODE, TILE_PROPERTY

INNER_GROUP = ".Skinglow tile"
#: How far a tile's number may be from a whole one: faces between two tiles, which modifiers and edits make, interpolate
#: it, and would show the texels of a third. Single precision keeps numbers up to a million to a sixteenth.
MAX_ROUNDING = 0.1


class Tiles(NamedTuple):
    """What the nodes find at a point."""

    color: Socket  #: radiance
    there: Socket  #: 1 where there is a tile, else 0
    use: Socket  #: 1 for an object that shows its tiles, else 0


def add_tiles(build: NodeBuilder) -> Tiles:
    """Adds the nodes to a skin's group."""
    texel = build.attribute("GEOMETRY", TEXEL_ATTRIBUTE, "Texel x, y, 1 + tile").outputs["Vector"]
    own = build.attribute("OBJECT", TILE_PROPERTY, "First row, texel width and height, use").outputs
    first_row, width, height = build.split(own["Vector"])
    size = build.combine(width, height)
    # The row is added to whole texels: added before, it would cost the fraction its last digits.
    center = build.combine(0.5, build.math("ADD", first_row, 0.5))
    cell = build.vector("ADD", build.vector("FLOOR", texel), center)
    corner = build.vector("MULTIPLY", cell, size, label="Texel below")
    inner = _tile_group()
    colors = []
    for step in ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)):
        node = build.instance(inner, "Texel")
        if not colors:
            node.name = TILE_NODE
        for name, value in (("Corner", corner), ("Size", size), ("Step", step)):
            build.set(node.inputs[name], value)
        colors.append(node.outputs["Color"])
    x, y, _z = build.split(build.vector("FRACTION", texel))
    lower, upper = (_mix(build, a, b, x) for a, b in (colors[:2], colors[2:]))
    tile = build.split(texel)[2]
    is_whole = build.math("COMPARE", tile, build.math("ROUND", tile), MAX_ROUNDING, label="Within one tile")
    there = build.math("MULTIPLY", is_whole, build.math("MINIMUM", tile, 1.0), label="There is a tile")
    return Tiles(_mix(build, lower, upper, y), there, own["Alpha"])


def _mix(build: NodeBuilder, a: Socket, b: Socket, fraction: Socket) -> Socket:
    return build.vector("MULTIPLY_ADD", build.vector("SUBTRACT", b, a), fraction, a)


def _tile_group() -> bpy.types.NodeTree:
    build, entry = inner_group(
        INNER_GROUP, {"Corner": "Vector", "Size": "Vector", "Step": "Vector"}, {"Color": "Color"}
    )
    given = entry.outputs
    coordinate = build.vector("MULTIPLY_ADD", given["Step"], given["Size"], given["Corner"])
    build.set(build.node("NodeGroupOutput").inputs["Color"], build.texel(coordinate, TILE_IMAGE_NODE).outputs["Color"])
    return build.tree
