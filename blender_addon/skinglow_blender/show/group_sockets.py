# SPDX-License-Identifier: GPL-3.0-or-later
"""The sockets of a skin's node group: what artists connect, and what they get."""

from typing import Any, NamedTuple

import bpy

from .. import blender_version

#: The value of Thickness that stands for the measured one.
MEASURED = -1.0


class GroupSocket(NamedTuple):
    """One socket of the interface."""

    name: str
    kind: str  #: 'Shader', 'Float', 'Factor' or 'Color'
    in_out: str  #: 'INPUT' or 'OUTPUT'
    description: str
    values: dict[str, Any] = {}  #: attributes of the interface socket


#: In the order in which files got them: nodes refer to sockets by identifiers that count up.
SOCKETS = (
    GroupSocket("Surface", "Shader", "INPUT", "The surface of the skin, unchanged"),
    GroupSocket("Shader", "Shader", "OUTPUT", "The surface plus the light transmitted through the skin"),
    GroupSocket(
        "Mask",
        "Factor",
        "INPUT",
        "Factor on the transmitted light: 0 where no light comes through, 1 where all does",
        {"default_value": 1.0, "min_value": 0.0, "max_value": 1.0},
    ),
    GroupSocket(
        "Thickness",
        "Float",
        "INPUT",
        "Thickness in mm at the size at which the skin was measured, instead of the measured one: a painted or baked "
        "map. Not connected, or negative: the measured thickness",
        {"default_value": MEASURED, "hide_value": True},
    ),
    GroupSocket(
        "Tint", "Color", "INPUT", "Factor on the color of the transmitted light", {"default_value": (1.0,) * 4}
    ),
    GroupSocket(
        "Strength",
        "Float",
        "INPUT",
        "Factor on the transmitted light, besides that of the object",
        {"default_value": 1.0, "min_value": 0.0, "max_value": 1e6},
    ),
    GroupSocket("Light", "Color", "OUTPUT", "The transmitted light alone, for AOV outputs and compositing"),
)


def ensure_sockets(group: bpy.types.NodeTree) -> None:
    """Adds the sockets that a group lacks, and gives the nodes that use it already their defaults."""
    there = {in_out: blender_version.group_sockets(group, in_out) for in_out in ("INPUT", "OUTPUT")}
    for socket in SOCKETS:
        if socket.name in there[socket.in_out]:
            continue
        blender_version.new_group_socket(
            group, socket.name, socket.kind, socket.in_out, socket.description, **socket.values
        )
        # Blender gives the nodes that there are zero.
        if "default_value" in socket.values:
            for node in nodes_with(group):
                node.inputs[socket.name].default_value = socket.values["default_value"]


def nodes_with(group: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """All nodes of the file that use a group, in materials and in other groups."""
    trees = [material.node_tree for material in bpy.data.materials] + list(bpy.data.node_groups)
    return [node for tree in trees if tree is not None for node in tree.nodes if uses(node, group)]


def uses(node: bpy.types.Node, group: bpy.types.NodeTree) -> bool:
    """Whether a node is an instance of the group."""
    return node.bl_idname == "ShaderNodeGroup" and node.node_tree == group


def replace_group(node: bpy.types.Node, group: bpy.types.NodeTree) -> None:
    """Lets a node use another skin group; what is connected to it and typed into it stays.

    Blender keeps links by identifiers, which differ between groups that were made by different versions of it.
    """
    tree = node.id_data
    into = [(link.from_socket, link.to_socket.name) for s in node.inputs for link in s.links]
    out = [(link.from_socket.name, link.to_socket) for s in node.outputs for link in s.links]
    values = {s.name: _value(s) for s in node.inputs if hasattr(s, "default_value")}
    node.node_tree = group
    for name, value in values.items():
        if name in node.inputs:
            node.inputs[name].default_value = value
    for source, name in into:
        if name in node.inputs:
            tree.links.new(source, node.inputs[name])
    for name, target in out:
        if name in node.outputs:
            tree.links.new(node.outputs[name], target)


def _value(socket: bpy.types.NodeSocket) -> Any:  # noqa: ANN401
    value = socket.default_value
    return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value
