# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that adds the transmitted light, looked up by thickness, to a surface (group_sockets.py).

Where the thickness is not known there is no light: what a modifier or an edit adds has no thickness, which reads as 0
and would otherwise pass for the thinnest skin.

The object's custom property provides its texels per mm, the width of a texel, the v coordinate of its row and its
strength; an object without the property has strength 0 and does not glow.

The two texels next to a thickness are read unfiltered and interpolated by nodes: EEVEE filters images with mip maps, in
which the rows of different skins bleed into each other, and with 8-bit weights.
"""

import bpy

from ..read.scene_reading import ROW_PROPERTY
from ..table.lut_layout import LAYOUT_PROPERTY
from ..thickness.thickness_attribute import KNOWN_ATTRIBUTE, MIN_KNOWN, THICKNESS_ATTRIBUTE
from .group_sockets import ensure_sockets
from .lut_image import GROUP_PROPERTY, GROUP_VERSION, NODE_NAMES, ensure_images, show_image, shown_image
from .node_building import NodeBuilder, Socket

GROUP_NAME = "Skinglow"
#: The inner groups of a group that lights per pixel (surface_group.py). Files hold them by these names.
INNER_GROUPS = (".Skinglow texel", ".Skinglow lamp", ".Skinglow lamp with profile")


def new_group() -> bpy.types.NodeTree:
    """Creates a group with its sockets and images, for plain rows."""
    group = bpy.data.node_groups.new(GROUP_NAME, "ShaderNodeTree")
    group[GROUP_PROPERTY] = GROUP_VERSION
    build_plain(group)
    ensure_images(group, 256, 1)
    return group


class RowSockets:
    """The common inputs of all skin groups: the group's own sockets, thickness and the object's property."""

    def __init__(self, build: NodeBuilder) -> None:
        self.given = build.node("NodeGroupInput").outputs
        self.thickness, known = measured_thickness(build, self.given["Thickness"])
        row = build.node("ShaderNodeAttribute", "Texels/mm, texel width, row, strength")
        row.attribute_type, row.attribute_name = "OBJECT", ROW_PROPERTY
        texels_per_mm, self.texel_width, self.row = build.split(row.outputs["Vector"])
        self.texel = build.math("MULTIPLY", self.thickness, texels_per_mm, label="Texel")
        strength = build.math("MULTIPLY", row.outputs["Alpha"], known, label="Strength where known")
        strength = build.math("MULTIPLY", strength, build.math("ADD", self.given["Mask"], 0.0, clamp=True))
        self.strength = build.math("MULTIPLY", strength, self.given["Strength"], label="Strength")


#: The mesh attributes that the nodes read, and the nodes' labels.
STORED = ((THICKNESS_ATTRIBUTE, "Thickness, mm"), (KNOWN_ATTRIBUTE, "Thickness known"))


def measured_thickness(build: NodeBuilder, given: Socket) -> tuple[Socket, Socket]:
    """The thickness in mm, and the share of it that is known.

    given  a thickness to use instead of the measured one where it is not negative
    """
    stored, known = (_mesh_attribute(build, *named) for named in STORED)
    # Between a known and an unknown vertex both are interpolated: their ratio is the known one's thickness.
    measured = build.math("DIVIDE", stored, build.math("MAXIMUM", known, MIN_KNOWN), label="Measured thickness, mm")
    is_measured = build.math("LESS_THAN", given, 0.0, label="No thickness is given")
    given = build.math("MAXIMUM", given, 0.0)
    return (
        build.math("MULTIPLY_ADD", measured, is_measured, given, label="Thickness, mm"),
        build.math("MAXIMUM", known, build.math("SUBTRACT", 1.0, is_measured), label="Known or given"),
    )


def _mesh_attribute(build: NodeBuilder, name: str, label: str) -> Socket:
    node = build.node("ShaderNodeAttribute", label)
    node.attribute_type, node.attribute_name = "GEOMETRY", name
    return node.outputs["Fac"]


def build_plain(group: bpy.types.NodeTree) -> None:
    """Rebuilds a skin group's nodes for plain rows, colors by thickness; its image is kept."""
    image = shown_image(group)
    clear(group)
    ensure_sockets(group)
    group.pop(LAYOUT_PROPERTY, None)
    build = NodeBuilder(group, -700.0, 200.0)
    row = RowSockets(build)
    below = build.math("FLOOR", row.texel)
    fraction = build.math("FRACT", row.texel)
    colors = []
    for name, offset in zip(NODE_NAMES, (0.5, 1.5), strict=True):
        u = build.math("MULTIPLY", build.math("ADD", below, offset), row.texel_width)
        lookup = new_lookup(build, build.combine(u, row.row), name)
        colors.append(lookup.outputs["Color"])
    step = build.vector("SUBTRACT", colors[1], colors[0])
    finish(build, build.vector("MULTIPLY_ADD", step, fraction, colors[0]), row)
    if image is not None:
        show_image(group, image)


def clear(group: bpy.types.NodeTree) -> None:
    """Deletes a skin group's nodes, and the inner groups that nothing else uses."""
    inner = {n.node_tree for n in group.nodes if n.bl_idname == "ShaderNodeGroup" and n.node_tree is not None}
    group.nodes.clear()
    for tree in inner:
        if tree.library is None and tree.users == 0 and tree.name.startswith(INNER_GROUPS):
            bpy.data.node_groups.remove(tree)


def new_lookup(build: NodeBuilder, coordinate: Socket, name: str) -> bpy.types.Node:
    """An image node that reads one texel of a skin's row."""
    lookup = build.node("ShaderNodeTexImage", "Transmitted light")
    lookup.name, lookup.extension, lookup.interpolation = name, "EXTEND", "Closest"
    build.set(lookup.inputs["Vector"], coordinate)
    return lookup


def finish(build: NodeBuilder, color: Socket, row: RowSockets) -> None:
    """Adds the light to the surface."""
    tinted = build.vector("MULTIPLY", color, row.given["Tint"])
    light = build.vector("SCALE", tinted, row.strength, label="Transmitted light")
    emission, add, out = (build.node(kind) for kind in ("ShaderNodeEmission", "ShaderNodeAddShader", "NodeGroupOutput"))
    build.set(emission.inputs["Color"], light)
    build.set(add.inputs[0], row.given["Surface"])
    build.set(add.inputs[1], emission.outputs[0])
    build.set(out.inputs["Shader"], add.outputs[0])
    build.set(out.inputs["Light"], light)
