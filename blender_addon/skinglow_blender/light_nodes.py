# SPDX-License-Identifier: GPL-3.0-or-later
"""What the nodes of a lamp multiply its colour and its power by."""

from typing import NamedTuple

import bpy

from . import blender_version


class NodeFactor(NamedTuple):
    """Colour and strength of a lamp's Emission node, and what of the nodes could not be followed."""

    color: tuple[float, float, float]
    strength: float
    note: str


WITHOUT_NODES = NodeFactor((1.0, 1.0, 1.0), 1.0, "")


def node_factor(light: bpy.types.Light) -> NodeFactor:
    """Reads the Emission node that drives a lamp.

    Plain values and RGB and Value nodes are followed; of anything else linked in, the socket's own value is taken
    and the note says so. Without an active output, or with nothing linked to it, the lamp is dark.
    """
    tree = blender_version.shader_tree(light)
    if tree is None:
        return WITHOUT_NODES
    output = tree.get_output_node("ALL")
    source = _linked_node(output.inputs["Surface"]) if output is not None else None
    if source is None:
        return NodeFactor((0.0, 0.0, 0.0), 0.0, "its nodes have no shader linked to the output")
    if source.bl_idname != "ShaderNodeEmission":
        return WITHOUT_NODES._replace(note=f"its node '{source.name}' is not an Emission and is not followed")
    color, color_note = _socket_value(source.inputs["Color"])
    strength, strength_note = _socket_value(source.inputs["Strength"])
    return NodeFactor(tuple(color)[:3], strength, color_note or strength_note)


def _linked_node(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    if not socket.is_linked:
        return None
    node = socket.links[0].from_node
    while node.bl_idname == "NodeReroute" and node.inputs[0].is_linked:
        node = node.inputs[0].links[0].from_node
    return node


def _socket_value(socket: bpy.types.NodeSocket) -> tuple[object, str]:
    node = _linked_node(socket)
    if node is None:
        return socket.default_value, ""
    if node.bl_idname in ("ShaderNodeRGB", "ShaderNodeValue"):
        value = node.outputs[0].default_value
        if socket.type == "RGBA" and isinstance(value, float):
            return (value, value, value), ""
        if socket.type == "VALUE" and not isinstance(value, float):
            return socket.default_value, f"its node '{node.name}' is a colour linked to {socket.name}"
        return value, ""
    return socket.default_value, f"its node '{node.name}' is not followed; {socket.name}'s own value is used"
