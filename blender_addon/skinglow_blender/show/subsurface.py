# SPDX-License-Identifier: GPL-3.0-or-later
"""Subsurface scattering of the user's own shader, which also brings light through thin parts: counted once.

The light that comes through is given either to the lookup, then a small group fades the shader's subsurface out where
the skin is thin; or to the shader, then the skin's node is muted and passes the surface on.
"""

from collections.abc import Iterator

import bpy

from .. import blender_version
from ..errors import SkinError
from .group_sockets import MEASURED
from .node_building import NodeBuilder
from .skin_group import measured_thickness
from .skin_material import skin_input, skin_nodes
from .surface_shaders import shaders_before

FADE_GROUP = "Skinglow Subsurface"
#: Custom property that marks the group and its version.
FADE_PROPERTY = "skinglow_subsurface"
FADE_VERSION = 1
#: Thickness in mm up to which subsurface is off, and from which it is as without Skinglow. Light skin lets 2.4 % of the
#: red light through 4 mm and 0.2 % through 8 mm (skinglow.TISSUE_PRESETS["light"]).
FADE_FROM_MM, FADE_TO_MM = 4.0, 8.0

#: Who shows the light that comes through.
SHOWN_BY = (
    ("SKINGLOW", "Skinglow", "Fade the subsurface of the shader where the skin is thin"),
    ("SUBSURFACE", "Subsurface", "Mute the Skinglow node: only the subsurface of the shader brings light through"),
)


def light_shown_by(material: bpy.types.Material) -> str:
    """Who shows the light that comes through: 'SKINGLOW', 'SUBSURFACE' or, counted twice, 'BOTH'."""
    nodes = skin_nodes(material)
    shining = [node for node in nodes if not node.mute and not _is_dark(node)]
    if not shining:
        return "SUBSURFACE" if nodes else "SKINGLOW"
    return "BOTH" if any(_fade_of(s) is None for node in shining for s in _scattering(node)) else "SKINGLOW"


def has_subsurface(material: bpy.types.Material) -> bool:
    """Whether the shader upstream of the skin's node scatters below the surface."""
    return any(True for node in skin_nodes(material) for _socket in _scattering(node))


def show_light_by(material: bpy.types.Material, shown_by: str) -> None:
    """Gives the light that comes through a material of a skin to "skinglow" or to its own "subsurface".

    Raises SkinError if that cannot be done, ValueError for another name.
    """
    shown_by = shown_by.upper()
    if shown_by not in ("SKINGLOW", "SUBSURFACE"):
        raise ValueError(
            f'show_light_by: shown_by = {shown_by!r} is not allowed: it has to be "skinglow" or "subsurface"'
        )
    nodes = skin_nodes(material)
    sockets = list(dict.fromkeys(socket for node in nodes for socket in _scattering(node)))
    for owner in dict.fromkeys([material, *(socket.id_data for socket in sockets)]):
        if owner.library is not None:
            raise SkinError(f"'{owner.name}' belongs to {owner.library.filepath}: make it local first")
    if shown_by == "SUBSURFACE" and any(node.outputs["Light"].is_linked for node in nodes if "Light" in node.outputs):
        # A muted node passes its Tint to Light.
        raise SkinError(f"Light of the Skinglow node in '{material.name}' is connected: disconnect it first")
    if shown_by == "SKINGLOW":
        for socket in sockets:
            if _fade_of(socket) is None:
                _check_may_fade(socket, material)
        for socket in sockets:
            if _fade_of(socket) is None:
                _add_fade(socket)
    else:
        for socket in sockets:
            _remove_fade(socket)
    for node in nodes:
        node.mute = shown_by == "SUBSURFACE"
    follow_sockets(material)


def restore_subsurface(material: bpy.types.Material) -> None:
    """Removes what `show_light_by` added to the user's shader."""
    for node in skin_nodes(material):
        for socket in _scattering(node):
            if socket.id_data.library is None:
                _remove_fade(socket)


def follow_sockets(material: bpy.types.Material) -> None:
    """Connects the Mask and Thickness of a skin's node to the fades as well."""
    for node in skin_nodes(material):
        for socket in _scattering(node):
            fade = _fade_of(socket)
            if fade is None or fade.id_data != node.id_data:
                continue
            for name in ("Mask", "Thickness"):
                if skin_input(node, name) is None:
                    continue
                for link in list(fade.inputs[name].links):
                    fade.id_data.links.remove(link)
                fade.inputs[name].default_value = node.inputs[name].default_value
                for link in node.inputs[name].links:
                    fade.id_data.links.new(link.from_socket, fade.inputs[name])


def _is_dark(node: bpy.types.Node) -> bool:
    sockets = [skin_input(node, name) for name in ("Mask", "Strength")]
    return any(s is not None and not s.is_linked and s.default_value <= 0.0 for s in sockets)


def _scattering(node: bpy.types.Node) -> Iterator[bpy.types.NodeSocket]:
    """The sockets upstream of a skin's node that say how much a shader scatters below the surface."""
    for shader in shaders_before(node):
        amount = None
        if shader.bl_idname == "ShaderNodeBsdfPrincipled":
            amount = blender_version.socket_named(shader.inputs, "Subsurface Weight", "Subsurface")
        elif shader.bl_idname == "ShaderNodeSubsurfaceScattering":
            amount = shader.inputs["Scale"]
        if amount is not None and (amount.is_linked or amount.default_value > 0.0):
            yield amount


def _fade_of(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    node = socket.links[0].from_node if socket.is_linked else None
    is_fade = node is not None and node.bl_idname == "ShaderNodeGroup" and FADE_PROPERTY in (node.node_tree or ())
    return node if is_fade else None


def _check_may_fade(socket: bpy.types.NodeSocket, material: bpy.types.Material) -> None:
    tree = socket.id_data
    if tree != material.node_tree and tree.users - tree.use_fake_user > 1:
        raise SkinError(
            f"The subsurface of '{material.name}' is in the node group '{tree.name}', which is used elsewhere too: "
            "make it a single user first"
        )
    if not socket.is_linked and blender_version.animation_curves(tree, socket.path_from_id("default_value")):
        raise SkinError(
            f"{socket.name} of '{socket.node.name}' in '{material.name}' is animated: connect a Value node and animate "
            "that first"
        )


def _add_fade(socket: bpy.types.NodeSocket) -> None:
    tree, node = socket.id_data, socket.node
    fade = tree.nodes.new("ShaderNodeGroup")
    fade.node_tree = _fade_group()
    fade.location = (node.location.x - 200, node.location.y - 250)
    if socket.is_linked:
        tree.links.new(socket.links[0].from_socket, fade.inputs["Amount"])
    else:
        fade.inputs["Amount"].default_value = socket.default_value
    tree.links.new(fade.outputs["Amount"], socket)


def _remove_fade(socket: bpy.types.NodeSocket) -> None:
    fade = _fade_of(socket)
    if fade is None:
        return
    tree, amount = socket.id_data, fade.inputs["Amount"]
    if amount.is_linked:
        tree.links.new(amount.links[0].from_socket, socket)
    else:
        socket.default_value = amount.default_value
    group = fade.node_tree
    tree.nodes.remove(fade)
    if group.library is None and group.users == 0:
        bpy.data.node_groups.remove(group)


def _fade_group() -> bpy.types.NodeTree:
    """The group that reduces an amount of subsurface where the skin's node shows light."""
    for group in bpy.data.node_groups:
        if group.get(FADE_PROPERTY) == FADE_VERSION and group.library is None:
            return group
    group = bpy.data.node_groups.new(FADE_GROUP, "ShaderNodeTree")
    group[FADE_PROPERTY] = FADE_VERSION
    for name, kind, value, description in (
        ("Amount", "Float", 1.0, "Subsurface as it is without Skinglow"),
        ("Mask", "Factor", 1.0, "As the Mask of the Skinglow node"),
        ("Thickness", "Float", MEASURED, "As the Thickness of the Skinglow node"),
        ("From", "Float", FADE_FROM_MM, "Thickness in mm up to which there is no subsurface"),
        ("To", "Float", FADE_TO_MM, "Thickness in mm from which subsurface is as without Skinglow"),
    ):
        hidden = {"hide_value": True} if name in ("Mask", "Thickness") else {}
        blender_version.new_group_socket(group, name, kind, "INPUT", description, default_value=value, **hidden)
    blender_version.new_group_socket(group, "Amount", "Float", "OUTPUT", "Subsurface, less where the skin is thin")
    build = NodeBuilder(group, -900.0, 200.0)
    given = build.node("NodeGroupInput").outputs
    thickness, known = measured_thickness(build, given["Thickness"])
    thick = build.node("ShaderNodeMapRange", "Thick")
    thick.interpolation_type = "SMOOTHSTEP"
    for name, value in (("Value", thickness), ("From Min", given["From"]), ("From Max", given["To"])):
        build.set(thick.inputs[name], value)
    shown = build.math("MULTIPLY", known, build.math("ADD", given["Mask"], 0.0, clamp=True), label="Light is shown")
    thin = build.math("SUBTRACT", 1.0, thick.outputs["Result"], label="Thin")
    fade = build.math("SUBTRACT", 1.0, build.math("MULTIPLY", thin, shown), label="Not thin, or not lit")
    build.set(build.node("NodeGroupOutput").inputs["Amount"], build.math("MULTIPLY", given["Amount"], fade))
    return group
