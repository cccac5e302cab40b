# SPDX-License-Identifier: GPL-3.0-or-later
"""Inserts the skin's node group into an object's materials and removes it."""

from collections.abc import Callable, Iterable

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..identity import library_of
from ..read import working_space
from .group_sockets import replace_group
from .lut_image import FROZEN_PROPERTY, is_skin_group, skin_groups
from .skin_group import new_group
from .surface_shaders import emits

#: Custom property of the node in a material: the material's original emission sampling.
SAMPLING_PROPERTY = "skinglow_sampling"
#: How far an output moves to the right for the node before it.
WIDTH = 200.0
#: A light skin, linear Rec.709, for objects without a material: the light skin patch of the ColorChecker chart
#: (sRGB 194, 150, 130; X-Rite's published values).
PLAIN_SKIN_COLOR = (0.5395, 0.3050, 0.2232)
PLAIN_SKIN_ROUGHNESS = 0.45


def chosen_materials(obj: bpy.types.Object) -> list[bpy.types.Material]:
    """The materials of an object that are skin: all but those that were left out.

    A library's material cannot be left out or added to: it is skin where it has the node.
    """
    materials = [slot.material for slot in obj.material_slots if slot.material is not None]
    return [m for m in dict.fromkeys(materials) if (m.skinglow.is_skin if library_of(m) is None else skin_node(m))]


def choose_slots(obj: bpy.types.Object, slots: Iterable[int | str]) -> Callable[[], None]:
    """Checks a choice of material slots, by index or name of the material; returns what makes the choice.

    Raises ValueError naming a slot that is not there, SkinError for one that cannot be skin.
    """
    there = {i: slot.material for i, slot in enumerate(obj.material_slots)}
    chosen = []
    for wanted in [slots] if isinstance(slots, (int, str)) else slots:
        found = [m for i, m in there.items() if m is not None and wanted in (i, m.name)]
        if not found:
            names = ", ".join(f"{i} '{m.name}'" for i, m in there.items() if m is not None)
            raise ValueError(
                f"make_skin: slots = {wanted!r} is not allowed: '{obj.name}' has the slots {names or 'none'}"
            )
        chosen += found
    _check_local(obj, chosen)
    if not chosen:
        raise ValueError(
            f"make_skin: slots = {slots!r} is not allowed: at least one slot of '{obj.name}' has to be skin"
        )

    def choose() -> None:
        for material in set(there.values()) - {None}:
            if library_of(material) is None and material.skinglow.is_skin != (material in chosen):
                material.skinglow.is_skin = material in chosen

    return choose


def add_to_materials(obj: bpy.types.Object, group: bpy.types.NodeTree | None) -> bpy.types.NodeTree:
    """Inserts the group after the surface of each of an object's materials that are skin; returns the group in use.

    A material that already has a skin group keeps it, so that objects which share a material share the group.
    """
    materials = chosen_materials(obj)
    if not materials:
        used = [slot.material for slot in obj.material_slots if slot.material is not None]
        if used:
            _check_local(obj, used)
            raise SkinError(f"None of the materials of '{obj.name}' is chosen as skin: choose one of its slots")
        materials = [_plain_skin(obj)]
    for material in materials:
        existing = skin_node(material)
        if existing is not None:
            group = existing.node_tree
            break
    if group is None:
        group = next((g for g in skin_groups() if g.library is None and FROZEN_PROPERTY not in g), None) or new_group()
    for material in materials:
        node = skin_node(material)
        if node is None:
            insert(material, group)
        elif node.node_tree != group and node.id_data.library is None:
            replace_group(node, group)
        if library_of(material) is None and not is_shown(material):
            _connect_again(material)
        _stop_sampling(material)
    return group


def _stop_sampling(material: bpy.types.Material) -> None:
    """Keeps Cycles from sampling each face of the skin as a light, and remembers how it did.

    It would spend most of its samples on them: three times the render time, for light too faint to need that. Where the
    user's own shader gives off light, that needs to be sampled.
    """
    nodes = [node for node in skin_nodes(material) if node.id_data.library is None]
    if any(map(emits, nodes)):
        return
    sampling = blender_version.emission_sampling(material)
    if material.library is None and sampling is not None and not any(SAMPLING_PROPERTY in node for node in nodes):
        blender_version.set_emission_sampling(material, blender_version.NO_EMISSION_SAMPLING)
        for node in nodes:
            node[SAMPLING_PROPERTY] = sampling


def _check_local(obj: bpy.types.Object, materials: list[bpy.types.Material]) -> None:
    for material in materials:
        library = library_of(material)
        if library is not None and skin_node(material) is None:
            raise SkinError(
                f"Material '{material.name}' of '{obj.name}' belongs to {library.filepath}: make it local "
                "(Object > Relations > Make Local > ... and Materials) or make the skin in that file"
            )


def skin_nodes(material: bpy.types.Material) -> list[bpy.types.Node]:
    """The material's skin group nodes: one for each of its outputs, also in groups of the artist."""
    return _skin_nodes_in(blender_version.shader_tree(material), set())


def _skin_nodes_in(tree: bpy.types.NodeTree | None, seen: set[bpy.types.NodeTree]) -> list[bpy.types.Node]:
    found: list[bpy.types.Node] = []
    if tree is None or tree in seen:
        return found
    seen.add(tree)
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeGroup":
            found += [node] if is_skin_group(node.node_tree) else _skin_nodes_in(node.node_tree, seen)
    return found


def skin_node(material: bpy.types.Material) -> bpy.types.Node | None:
    """The material's first skin group node, or None."""
    return next(iter(skin_nodes(material)), None)


def is_shown(material: bpy.types.Material) -> bool:
    """Whether what a material shows, or one of its AOVs, comes from a skin's node."""
    tree = blender_version.shader_tree(material)
    if tree is None:
        return False
    ends = [*_outputs(tree), *(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputAOV")]
    seen: set[bpy.types.Node] = set()
    while ends:
        node = ends.pop()
        if node in seen:
            continue
        seen.add(node)
        if node.bl_idname == "ShaderNodeGroup":
            if is_skin_group(node.node_tree) or _skin_nodes_in(node.node_tree, set()):
                return True
        ends += [link.from_node for socket in node.inputs for link in socket.links if not link.is_muted]
    return False


def _outputs(tree: bpy.types.NodeTree) -> set[bpy.types.Node]:
    """The outputs that the renderers take."""
    return {o for o in (tree.get_output_node(t) for t in ("ALL", "CYCLES", "EEVEE")) if o is not None}


def _connect_again(material: bpy.types.Material) -> None:
    """Puts a node that nothing shows any more before the output, behind the shader that was connected to that."""
    tree = blender_version.shader_tree(material)
    node = next((node for node in skin_nodes(material) if node.id_data == tree), None)
    if node is None:
        return  # in a group of the artist
    for output in _outputs(tree) or {tree.nodes.new("ShaderNodeOutputMaterial")}:
        surface = output.inputs["Surface"]
        if surface.is_linked:
            tree.links.new(surface.links[0].from_socket, node.inputs["Surface"])
        tree.links.new(node.outputs["Shader"], surface)


def skin_input(node: bpy.types.Node, name: str) -> bpy.types.NodeSocket | None:
    """An input of a skin's node; None where its group is a library's of an earlier version."""
    return node.inputs.get(name)


def gives_thickness(material: bpy.types.Material) -> bool:
    """Whether a material has a thickness of its own, so that the measured one does not matter."""
    inputs = [skin_input(node, "Thickness") for node in skin_nodes(material)]
    return bool(inputs) and all(s is not None and (s.is_linked or s.default_value >= 0.0) for s in inputs)


def remove_from_material(material: bpy.types.Material) -> None:
    """Removes the group and reconnects the surface to the output."""
    for node in skin_nodes(material):
        tree = node.id_data
        if tree.library is not None:
            continue
        surface = node.inputs["Surface"]
        before = surface.links[0].from_socket if surface.is_linked else None
        after = [link.to_socket for link in node.outputs["Shader"].links]
        for socket in after:
            if before is not None:
                tree.links.new(before, socket)
            if (socket.node.location.x - WIDTH, socket.node.location.y) == tuple(node.location):
                socket.node.location.x -= WIDTH  # where it was
        if SAMPLING_PROPERTY in node:
            blender_version.set_emission_sampling(material, node[SAMPLING_PROPERTY])
        tree.nodes.remove(node)


def insert(material: bpy.types.Material, group: bpy.types.NodeTree) -> None:
    """Inserts the group between a material's surface and its outputs."""
    plain = blender_version.shader_tree(material) is None
    tree = blender_version.ensure_shader_tree(material)
    if plain:
        _color_principled(tree, tuple(material.diffuse_color), material.roughness)
    for output in _outputs(tree) or {tree.nodes.new("ShaderNodeOutputMaterial")}:
        surface = output.inputs["Surface"]
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.location = (output.location.x, output.location.y)
        output.location.x += WIDTH
        if surface.is_linked:
            tree.links.new(surface.links[0].from_socket, node.inputs["Surface"])
        tree.links.new(node.outputs["Shader"], surface)
    _stop_sampling(material)


def _plain_skin(obj: bpy.types.Object) -> bpy.types.Material:
    if obj.data.library is not None:
        raise SkinError(f"'{obj.name}' has no material, and its mesh is linked from a library: add a material there")
    material = bpy.data.materials.new("Skin")
    tree = blender_version.ensure_shader_tree(material)
    color = working_space.from_rec709(np.array(PLAIN_SKIN_COLOR))
    _color_principled(tree, (*color, 1.0), PLAIN_SKIN_ROUGHNESS)
    if obj.material_slots:
        obj.material_slots[0].material = material
    else:
        obj.data.materials.append(material)
    return material


def _color_principled(tree: bpy.types.NodeTree, color: tuple[float, ...], roughness: float) -> None:
    principled = next((n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled"), None)
    if principled is not None:
        principled.inputs["Base Color"].default_value = color
        principled.inputs["Roughness"].default_value = roughness
