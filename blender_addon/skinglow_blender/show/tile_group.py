# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes that read light from tiles: four texels about a point of the skin, interpolated.

Each corner of the mesh stores its texel coordinates, which Blender interpolates over the face like a UV map; so they
follow every modifier that keeps attributes, and no location in space is involved.
"""

from typing import NamedTuple

from ..thickness.tile_attribute import TEXEL_ATTRIBUTE
from .inner_groups import TILE_NODE, inner_groups_of
from .node_building import NodeBuilder, Socket
from .tile_image import FIRST_TEXEL_PROPERTY, TEXEL_SIZE_PROPERTY

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
    first = build.attribute("OBJECT", FIRST_TEXEL_PROPERTY, "First texel, use").outputs
    size = build.attribute("OBJECT", TEXEL_SIZE_PROPERTY, "Size of a texel").outputs["Vector"]
    corner = build.vector("MULTIPLY_ADD", build.vector("FLOOR", texel), size, first["Vector"], label="Texel below")
    inner = inner_groups_of(build.tree)[TILE_NODE]
    colors = []
    for step in (None, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)):
        node = build.instance(inner, "Texel")
        at = corner if step is None else build.vector("MULTIPLY_ADD", size, step, corner)
        build.set(node.inputs["Texel"], at)
        colors.append(node.outputs["Color"])
    x, y, tile = build.split(texel)
    x, y = (build.math("FRACT", each) for each in (x, y))
    lower, upper = (build.mix(a, b, x) for a, b in (colors[:2], colors[2:]))
    nearest = build.math("MAXIMUM", build.math("ROUND", tile), 1.0)
    there = build.math("COMPARE", tile, nearest, MAX_ROUNDING, label="Within one tile")
    return Tiles(build.mix(lower, upper, y), there, first["Alpha"])
