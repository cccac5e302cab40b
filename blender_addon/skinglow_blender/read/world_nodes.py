# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of a world's nodes on a diffuse surface: Background nodes, mixed and added, each a color or an image."""

from typing import NamedTuple

import bpy

from ..identity import lasting_key_of
from .node_values import linked_node, linked_socket, socket_value
from .world_mapping import IDENTITY, Rows, image_from_world

IMAGE_NODE = "ShaderNodeTexEnvironment"


class Background(NamedTuple):
    """The light of one Background node."""

    color: tuple[float, float, float]  #: radiance, W/(m^2 sr); with an image, the image's factor
    image: str  #: lasting_key_of the image; "": none
    projection: str  #: of the image, 'EQUIRECTANGULAR' or 'MIRROR_BALL'
    image_from_world: Rows  #: orthogonal; maps world directions to image directions


class WorldLight(NamedTuple):
    """The backgrounds found, and a note of what is not supported."""

    backgrounds: tuple[Background, ...]
    note: str


def read_world_nodes(tree: bpy.types.NodeTree, target: str) -> WorldLight:
    """Reads the backgrounds that contribute to a world's active output for `target` (blender_version.output_target)."""
    output = tree.get_output_node(target)
    source = linked_node(output.inputs["Surface"]) if output is not None else None
    if source is None:
        return WorldLight((), "its nodes have no shader linked to the output")
    return _read_shader(source, 1.0)


def _read_shader(node: bpy.types.Node | None, factor: float) -> WorldLight:
    if node is None or factor == 0.0:
        return WorldLight((), "")
    if node.bl_idname == "ShaderNodeBackground":
        return _read_background(node, factor)
    if node.bl_idname == "ShaderNodeAddShader":
        return _added(*(_read_shader(linked_node(socket), factor) for socket in node.inputs))
    if node.bl_idname == "ShaderNodeMixShader":
        fraction, note = _mix_fraction(node.inputs[0])
        first, second = (linked_node(socket) for socket in node.inputs[1:3])
        mixed = _added(_read_shader(first, factor * (1.0 - fraction)), _read_shader(second, factor * fraction))
        return mixed._replace(note=note or mixed.note)
    return WorldLight((), f"its node '{node.name}' is not a Background node and is ignored")


def _added(first: WorldLight, second: WorldLight) -> WorldLight:
    return WorldLight(first.backgrounds + second.backgrounds, first.note or second.note)


def _mix_fraction(socket: bpy.types.NodeSocket) -> tuple[float, str]:
    source = linked_socket(socket)
    if source is not None and source.node.bl_idname == "ShaderNodeLightPath" and source.name == "Is Camera Ray":
        # The usual setup that shows the camera another sky than the one that lights the scene.
        return 0.0, ""
    value, note = socket_value(socket)
    return min(max(value, 0.0), 1.0), note


def _read_background(node: bpy.types.Node, factor: float) -> WorldLight:
    strength, note = socket_value(node.inputs["Strength"])
    strength *= factor
    source = linked_node(node.inputs["Color"])
    if source is not None and source.bl_idname == IMAGE_NODE:
        if source.image is None:
            return WorldLight((), f"its node '{source.name}' has no image")
        rows, mapping_note = image_from_world(source.inputs["Vector"])
        image = lasting_key_of(source.image)
        light = Background((strength,) * 3, image, source.projection, rows)
        return WorldLight((light,), note or mapping_note)
    color, color_note = socket_value(node.inputs["Color"])
    if color_note:
        # The color in the socket is not the one rendered: no light, with a note, is better than a wrong color.
        return WorldLight((), f"its node '{source.name}' is not supported and lights nothing")
    radiance = tuple(float(c) * strength for c in tuple(color)[:3])
    return WorldLight((Background(radiance, "", "", IDENTITY),), note)
