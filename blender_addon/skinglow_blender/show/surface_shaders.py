# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's own shader, which stands before the node of a skin."""

from collections.abc import Iterator

import bpy

from .. import blender_version


def shaders_before(node: bpy.types.Node) -> Iterator[bpy.types.Node]:
    """The nodes that make up the Surface of a skin's node, in node groups too, but for muted ones."""
    yield from _upstream(node.inputs["Surface"], set())


def _upstream(socket: bpy.types.NodeSocket, seen: set[bpy.types.Node]) -> Iterator[bpy.types.Node]:
    for link in socket.links:
        node = link.from_node
        if node in seen:
            continue
        seen.add(node)
        if not node.mute:
            yield node
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree is not None and not node.mute:
            for inner in node.node_tree.nodes:
                if inner.bl_idname == "NodeGroupOutput" and inner.is_active_output:
                    yield from _upstream(inner.inputs[link.from_socket.name], seen)
        for each in node.inputs:
            if each.type == "SHADER" or node.bl_idname == "NodeReroute":
                yield from _upstream(each, seen)


def emits(node: bpy.types.Node) -> bool:
    """Whether the shader before a skin's node gives off light of its own."""
    return any(_emits(shader) for shader in shaders_before(node))


def _emits(shader: bpy.types.Node) -> bool:
    if shader.bl_idname == "ShaderNodeEmission":
        names = ("Color",), ("Strength",)
    elif shader.bl_idname == "ShaderNodeBsdfPrincipled":
        names = ("Emission Color", "Emission"), ("Emission Strength",)
    else:
        return False
    color, strength = (blender_version.socket_named(shader.inputs, *each) for each in names)
    is_black = not color.is_linked and not any(color.default_value[:3])
    return not is_black and (strength.is_linked or strength.default_value > 0.0)
