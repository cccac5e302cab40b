# SPDX-License-Identifier: GPL-3.0-or-later
"""The factors by which a light's nodes multiply its color and its power."""

from typing import NamedTuple

import bpy

from .. import blender_version
from .node_values import linked_node, socket_value


class NodeFactor(NamedTuple):
    """Color and strength of a light's Emission node, and a note of what in the nodes is not supported."""

    color: tuple[float, float, float]
    strength: float
    note: str


WITHOUT_NODES = NodeFactor((1.0, 1.0, 1.0), 1.0, "")


def node_factor(light: bpy.types.Light, target: str) -> NodeFactor:
    """Reads the Emission node that drives a light in the renders of `target` (blender_version.output_target).

    Its values are evaluated as far as node_values.py can. Without an active output, or with nothing linked to it, the
    light is dark.
    """
    tree = blender_version.shader_tree(light)
    if tree is None:
        return WITHOUT_NODES
    output = tree.get_output_node(target)
    source = linked_node(output.inputs["Surface"]) if output is not None else None
    if source is None:
        return NodeFactor((0.0, 0.0, 0.0), 0.0, "its nodes have no shader linked to the output")
    if source.bl_idname != "ShaderNodeEmission":
        return WITHOUT_NODES._replace(note=f"its node '{source.name}' is not an Emission node and is ignored")
    color, color_note = socket_value(source.inputs["Color"])
    strength, strength_note = socket_value(source.inputs["Strength"])
    return NodeFactor(tuple(color)[:3], strength, color_note or strength_note)
