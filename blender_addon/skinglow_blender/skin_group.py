# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that turns thickness into light coming through: Surface in, Shader out, the light added between.

The object's custom property gives, for each object on the material, its texels per mm, the width of a texel, the
height of its row and its strength; an object without the property has strength 0 and does not glow.

The two texels about a thickness are read without filtering and mixed by nodes: EEVEE filters an image with mip maps, in
which the rows of different skins run together, and by weights of eight bits.
"""

import bpy

from . import blender_version
from .lut_image import GROUP_PROPERTY, NODE_NAMES, ensure_images, show_image, shown_image
from .lut_layout import LAYOUT_PROPERTY
from .node_building import NodeBuilder, Socket
from .scene_reading import ROW_PROPERTY

GROUP_NAME = "Skinglow"
THICKNESS_ATTRIBUTE = "skinglow_thickness"
#: The groups inside a group for surface weights (surface_group.py).
INNER_GROUPS = (".Skinglow texel", ".Skinglow lamp", ".Skinglow lamp with profile")


def new_group() -> bpy.types.NodeTree:
    """Builds the group with its sockets and its images, for plain rows."""
    group = bpy.data.node_groups.new(GROUP_NAME, "ShaderNodeTree")
    blender_version.new_group_socket(group, "Surface", "NodeSocketShader", "INPUT", "The skin's surface, kept as it is")
    blender_version.new_group_socket(
        group, "Shader", "NodeSocketShader", "OUTPUT", "The surface and the light coming through the skin"
    )
    group[GROUP_PROPERTY] = 1
    build_plain(group)
    ensure_images(group, 256, 1)
    return group


class RowSockets:
    """What every skin group reads first: thickness, and what the object's property says."""

    def __init__(self, build: NodeBuilder) -> None:
        thickness = build.node("ShaderNodeAttribute", "Thickness, mm")
        thickness.attribute_type, thickness.attribute_name = "GEOMETRY", THICKNESS_ATTRIBUTE
        row = build.node("ShaderNodeAttribute", "Texels/mm, texel width, row, strength")
        row.attribute_type, row.attribute_name = "OBJECT", ROW_PROPERTY
        texels_per_mm, self.texel_width, self.row = build.split(row.outputs["Vector"])
        self.strength = row.outputs["Alpha"]
        self.thickness = thickness.outputs["Fac"]
        self.texel = build.math("MULTIPLY", self.thickness, texels_per_mm, label="Texel")


def build_plain(group: bpy.types.NodeTree) -> None:
    """Makes a skin group's nodes anew for plain rows, colors by thickness; the image it showed stays in it."""
    image = shown_image(group)
    clear(group)
    group.pop(LAYOUT_PROPERTY, None)
    build = NodeBuilder(group, -700.0, 200.0)
    row = RowSockets(build)
    below = build.math("FLOOR", row.texel)
    share = build.math("FRACT", row.texel)
    colors = []
    for name, to_center in zip(NODE_NAMES, (0.5, 1.5), strict=True):
        along = build.math("MULTIPLY", build.math("ADD", below, to_center), row.texel_width)
        lookup = new_lookup(build, build.combine(along, row.row), name)
        colors.append(lookup.outputs["Color"])
    step = build.vector("SUBTRACT", colors[1], colors[0])
    finish(build, build.vector("MULTIPLY_ADD", step, share, colors[0]), row.strength)
    if image is not None:
        show_image(group, image)


def clear(group: bpy.types.NodeTree) -> None:
    """Deletes a skin group's nodes, and the groups inside that nothing else uses."""
    inner = {n.node_tree for n in group.nodes if n.bl_idname == "ShaderNodeGroup" and n.node_tree is not None}
    group.nodes.clear()
    for tree in inner:
        if tree.library is None and tree.users == 0 and tree.name.startswith(INNER_GROUPS):
            bpy.data.node_groups.remove(tree)


def new_lookup(build: NodeBuilder, place: Socket, name: str) -> bpy.types.Node:
    """An image node that reads one texel of a skin's row."""
    lookup = build.node("ShaderNodeTexImage", "Light coming through")
    lookup.name, lookup.extension, lookup.interpolation = name, "EXTEND", "Closest"
    build.give(lookup.inputs["Vector"], place)
    return lookup


def finish(build: NodeBuilder, color: Socket, strength: Socket) -> None:
    """Adds the light to the surface."""
    group = build.tree
    emission = build.node("ShaderNodeEmission", "Light coming through")
    build.give(emission.inputs["Color"], color)
    build.give(emission.inputs["Strength"], strength)
    surface, add, shader = (build.node(kind) for kind in ("NodeGroupInput", "ShaderNodeAddShader", "NodeGroupOutput"))
    group.links.new(surface.outputs["Surface"], add.inputs[0])
    group.links.new(emission.outputs[0], add.inputs[1])
    group.links.new(add.outputs[0], shader.inputs["Shader"])
