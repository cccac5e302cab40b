# SPDX-License-Identifier: GPL-3.0-or-later
"""What the nodes of a world send to a diffuse surface: Background nodes, mixed and added, each a color or an image."""

from typing import NamedTuple

import bpy

from .node_values import linked_node, linked_socket, socket_value
from .world_mapping import IDENTITY, Rows, image_from_world

IMAGE_NODE = "ShaderNodeTexEnvironment"


class Background(NamedTuple):
    """The light of one Background node."""

    color: tuple[float, float, float]  #: radiance, W/(m^2 sr); with an image, what the image is multiplied by
    image: str  #: name with library of the image; "": none
    projection: str  #: of the image, 'EQUIRECTANGULAR' or 'MIRROR_BALL'
    image_from_world: Rows  #: takes a direction of the world to the image's, orthogonal


class Followed(NamedTuple):
    """What was found, and what could not be followed."""

    backgrounds: tuple[Background, ...]
    note: str


def follow_world(tree: bpy.types.NodeTree) -> Followed:
    """Reads the backgrounds that reach a world's active output."""
    output = tree.get_output_node("ALL")
    source = linked_node(output.inputs["Surface"]) if output is not None else None
    if source is None:
        return Followed((), "its nodes have no shader linked to the output")
    return _follow_shader(source, 1.0)


def _follow_shader(node: bpy.types.Node | None, share: float) -> Followed:
    if node is None or share == 0.0:
        return Followed((), "")
    if node.bl_idname == "ShaderNodeBackground":
        return _follow_background(node, share)
    if node.bl_idname == "ShaderNodeAddShader":
        return _together(*(_follow_shader(linked_node(socket), share) for socket in node.inputs))
    if node.bl_idname == "ShaderNodeMixShader":
        fraction, note = _mix_fraction(node.inputs[0])
        first, second = (linked_node(socket) for socket in node.inputs[1:3])
        mixed = _together(_follow_shader(first, share * (1.0 - fraction)), _follow_shader(second, share * fraction))
        return mixed._replace(note=note or mixed.note)
    return Followed((), f"its node '{node.name}' is no Background and is not followed")


def _together(first: Followed, second: Followed) -> Followed:
    return Followed(first.backgrounds + second.backgrounds, first.note or second.note)


def _mix_fraction(socket: bpy.types.NodeSocket) -> tuple[float, str]:
    source = linked_socket(socket)
    if source is not None and source.node.bl_idname == "ShaderNodeLightPath" and source.name == "Is Camera Ray":
        # The usual way to show the camera another sky than the one that lights the scene.
        return 0.0, ""
    value, note = socket_value(socket)
    return min(max(value, 0.0), 1.0), note


def _follow_background(node: bpy.types.Node, share: float) -> Followed:
    strength, note = socket_value(node.inputs["Strength"])
    strength *= share
    source = linked_node(node.inputs["Color"])
    if source is not None and source.bl_idname == IMAGE_NODE:
        if source.image is None:
            return Followed((), f"its node '{source.name}' has no image")
        rows, mapping_note = image_from_world(source.inputs["Vector"])
        image = source.image.original.name_full
        light = Background((strength,) * 3, image, source.projection, rows)
        return Followed((light,), note or mapping_note)
    color, color_note = socket_value(node.inputs["Color"])
    if color_note:
        # The color in the socket is not what is seen here: better dark, and say so, than any color.
        return Followed((), f"its node '{source.name}' is not followed and lights nothing here")
    radiance = tuple(float(c) * strength for c in tuple(color)[:3])
    return Followed((Background(radiance, "", "", IDENTITY),), note)
