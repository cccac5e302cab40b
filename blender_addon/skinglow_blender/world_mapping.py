# SPDX-License-Identifier: GPL-3.0-or-later
"""How the nodes before an Environment Texture turn the world's directions into the image's."""

import bpy
from mathutils import Euler, Matrix

from .node_values import linked_socket, socket_value

#: The rows of a 3 by 3 matrix.
Rows = tuple[tuple[float, float, float], ...]

IDENTITY: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
#: Relative difference of scales that single-precision settings may have by themselves.
SAME_SCALE = 1e-5


def image_from_world(socket: bpy.types.NodeSocket) -> tuple[Rows, str]:
    """The orthogonal matrix from a direction of the world to one of the image, and a note of what was not followed.

    Mapping nodes of every type are followed in rotation and mirroring, however many, behind Texture Coordinate's
    Generated, or Object with an object that has a rotation. A location and uneven scales are not.
    """
    turned = Matrix.Identity(3)
    source = linked_socket(socket)
    note = ""
    while source is not None and source.node.bl_idname == "ShaderNodeMapping":
        mapping, mapping_note = _of_mapping(source.node)
        turned = turned @ mapping
        note = note or mapping_note
        following = linked_socket(source.node.inputs["Vector"])
        if following is None:
            note = note or f"its node '{source.node.name}' has no Vector, which is taken as Generated"
        source = following
    if source is not None:
        coordinate, coordinate_note = _of_coordinate(source)
        turned = turned @ coordinate
        note = note or coordinate_note
    return tuple(tuple(row) for row in turned), note


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
        notes.append(f"the Location of its node '{node.name}' is not followed")
    if _is_uneven(scale):
        notes.append(f"the uneven Scale of its node '{node.name}' is not followed")
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
                note = f"the place of '{node.object.name}', whose coordinates it uses, is not followed"
            if _is_uneven(tuple(world.to_scale())):
                note = f"the uneven scale of '{node.object.name}', whose coordinates it uses, is not followed"
            return world.to_quaternion().to_matrix().transposed(), note
    return Matrix.Identity(3), f"{socket.name} of its node '{node.name}' is not followed; Generated is used"


def _is_uneven(scale: tuple[float, ...]) -> bool:
    sizes = [abs(s) for s in scale]
    return min(sizes) == 0.0 or max(sizes) - min(sizes) > SAME_SCALE * max(sizes)
