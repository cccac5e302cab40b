# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping from world directions to image directions by the nodes before an Environment Texture."""

import bpy
from mathutils import Euler, Matrix

from .node_values import linked_socket, socket_value

#: The rows of a 3 by 3 matrix.
Rows = tuple[tuple[float, float, float], ...]

IDENTITY: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
#: Relative difference of scales that may come from single precision alone.
SAME_SCALE = 1e-5


def image_from_world(socket: bpy.types.NodeSocket) -> tuple[Rows, str]:
    """The orthogonal matrix from world to image directions, and a note of what is not supported.

    Any chain of Mapping nodes of every type is supported, as far as it rotates and mirrors, behind Texture Coordinate's
    Generated, or Object with a rotated object. Locations and non-uniform scales are not.
    """
    total = Matrix.Identity(3)
    source = linked_socket(socket)
    note = ""
    while source is not None and source.node.bl_idname == "ShaderNodeMapping":
        mapping, mapping_note = _of_mapping(source.node)
        total = total @ mapping
        note = note or mapping_note
        following = linked_socket(source.node.inputs["Vector"])
        if following is None:
            note = note or f"its node '{source.node.name}' has no Vector input: Generated is used"
        source = following
    if source is not None:
        coordinate, coordinate_note = _of_coordinate(source)
        total = total @ coordinate
        note = note or coordinate_note
    return tuple(tuple(row) for row in total), note


def _of_mapping(node: bpy.types.Node) -> tuple[Matrix, str]:
    values, notes = {}, []
    for name in ("Location", "Rotation", "Scale"):
        if name in node.inputs and node.inputs[name].enabled:
            values[name], note = socket_value(node.inputs[name])
            notes.append(note)
    scale = tuple(values["Scale"])
    signs = Matrix.Diagonal([-1.0 if s < 0.0 else 1.0 for s in scale])
    rotation = Euler(values["Rotation"], "XYZ").to_matrix()
    if any(values.get("Location", ())):
        notes.append(f"the Location of its node '{node.name}' is ignored")
    if _is_non_uniform(scale):
        notes.append(f"the non-uniform Scale of its node '{node.name}' is ignored")
    matrix = signs @ rotation.transposed() if node.vector_type == "TEXTURE" else rotation @ signs
    return matrix, next(filter(None, notes), "")


def _of_coordinate(socket: bpy.types.NodeSocket) -> tuple[Matrix, str]:
    node = socket.node
    if node.bl_idname == "ShaderNodeTexCoord":
        if socket.name == "Generated" or (socket.name == "Object" and node.object is None):
            return Matrix.Identity(3), ""
        if socket.name == "Object":
            world = node.object.matrix_world
            note = ""
            if any(world.translation):
                note = f"the location of '{node.object.name}', whose coordinates it uses, is ignored"
            if _is_non_uniform(tuple(world.to_scale())):
                note = f"the non-uniform scale of '{node.object.name}', whose coordinates it uses, is ignored"
            return world.to_quaternion().to_matrix().transposed(), note
    return Matrix.Identity(3), f"{socket.name} of its node '{node.name}' is not supported: Generated is used"


def _is_non_uniform(scale: tuple[float, ...]) -> bool:
    sizes = [abs(s) for s in scale]
    return min(sizes) == 0.0 or max(sizes) - min(sizes) > SAME_SCALE * max(sizes)
