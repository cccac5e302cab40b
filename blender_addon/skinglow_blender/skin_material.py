# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that turns thickness into light coming through, and its place in a skin's materials."""

import bpy
import numpy as np

from . import blender_version, working_space
from .errors import SkinError
from .lut_image import GROUP_PROPERTY, NODE_NAMES, ensure_images, is_skin_group, skin_groups
from .scene_reading import ROW_PROPERTY

GROUP_NAME = "Skinglow"
THICKNESS_ATTRIBUTE = "skinglow_thickness"

#: A light skin, linear Rec.709, for objects without a material: the light skin patch of the ColorChecker chart
#: (sRGB 194, 150, 130; X-Rite's published values).
PLAIN_SKIN_COLOR = (0.5395, 0.3050, 0.2232)
PLAIN_SKIN_ROUGHNESS = 0.45


def new_group() -> bpy.types.NodeTree:
    """Builds the node group: Surface in, Shader out, the light coming through added between.

    The object's custom property gives, for each object on the material, its texels per mm, the width of a texel, the
    height of its row and its strength; an object without the property has strength 0 and does not glow.

    The two texels about a thickness are read without filtering and mixed by nodes: EEVEE filters an image with mip
    maps, in which the rows of different skins run together, and by weights of eight bits.
    """
    group = bpy.data.node_groups.new(GROUP_NAME, "ShaderNodeTree")
    blender_version.new_group_socket(group, "Surface", "NodeSocketShader", "INPUT", "The skin's surface, kept as it is")
    blender_version.new_group_socket(
        group, "Shader", "NodeSocketShader", "OUTPUT", "The surface and the light coming through the skin"
    )
    surface = _node(group, "NodeGroupInput", 900, 250)
    shader = _node(group, "NodeGroupOutput", 1300, 150)
    thickness = _node(group, "ShaderNodeAttribute", -700, 200, "Thickness, mm")
    thickness.attribute_type, thickness.attribute_name = "GEOMETRY", THICKNESS_ATTRIBUTE
    row = _node(group, "ShaderNodeAttribute", -700, -50, "Texels/mm, texel width, row, strength")
    row.attribute_type, row.attribute_name = "OBJECT", ROW_PROPERTY
    split = _node(group, "ShaderNodeSeparateXYZ", -500, -50)
    _link(group, row.outputs["Vector"], split.inputs[0])
    texel = _math(group, "MULTIPLY", -300, 200, thickness.outputs["Fac"], split.outputs["X"], "Texel")
    below = _math(group, "FLOOR", -100, 100, texel)
    share = _math(group, "FRACT", -100, 300, texel)

    colors = []
    for y, name, to_centre in ((100, NODE_NAMES[0], 0.5), (-200, NODE_NAMES[1], 1.5)):
        centre = _math(group, "ADD", 100, y, below, to_centre)
        along = _math(group, "MULTIPLY", 250, y, centre, split.outputs["Y"])
        place = _node(group, "ShaderNodeCombineXYZ", 400, y)
        lookup = _node(group, "ShaderNodeTexImage", 550, y, "Light coming through")
        lookup.name, lookup.extension, lookup.interpolation = name, "EXTEND", "Closest"
        _link(group, along, place.inputs["X"])
        _link(group, split.outputs["Z"], place.inputs["Y"])
        _link(group, place.outputs[0], lookup.inputs["Vector"])
        colors.append(lookup.outputs["Color"])
    step = _node(group, "ShaderNodeVectorMath", 800, -100)
    step.operation = "SUBTRACT"
    _link(group, colors[1], step.inputs[0])
    _link(group, colors[0], step.inputs[1])
    mix = _node(group, "ShaderNodeVectorMath", 950, 0)
    mix.operation = "MULTIPLY_ADD"
    for socket, source in zip(mix.inputs, (step.outputs[0], share, colors[0]), strict=False):
        _link(group, source, socket)

    emission = _node(group, "ShaderNodeEmission", 1100, 0)
    _link(group, mix.outputs[0], emission.inputs["Color"])
    _link(group, row.outputs["Alpha"], emission.inputs["Strength"])
    add = _node(group, "ShaderNodeAddShader", 1200, 150)
    _link(group, surface.outputs["Surface"], add.inputs[0])
    _link(group, emission.outputs[0], add.inputs[1])
    _link(group, add.outputs[0], shader.inputs["Shader"])
    group[GROUP_PROPERTY] = 1
    ensure_images(group, 256, 1)
    return group


def _node(group: bpy.types.NodeTree, kind: str, x: float, y: float, label: str = "") -> bpy.types.Node:
    node = group.nodes.new(kind)
    node.location, node.label = (x, y), label
    return node


def _link(group: bpy.types.NodeTree, source: bpy.types.NodeSocket, target: bpy.types.NodeSocket) -> None:
    group.links.new(source, target)


def _math(
    group: bpy.types.NodeTree,
    operation: str,
    x: float,
    y: float,
    first: bpy.types.NodeSocket,
    second: bpy.types.NodeSocket | float = 0.0,
    label: str = "",
) -> bpy.types.NodeSocket:
    node = _node(group, "ShaderNodeMath", x, y, label)
    node.operation = operation
    _link(group, first, node.inputs[0])
    if isinstance(second, float):
        node.inputs[1].default_value = second
    else:
        _link(group, second, node.inputs[1])
    return node.outputs[0]


def add_to_materials(obj: bpy.types.Object, group: bpy.types.NodeTree | None) -> bpy.types.NodeTree:
    """Puts the group behind the surface of each of an object's materials; returns the group that is there.

    A material that has a skin group keeps it, so that objects which share a material share the group.
    """
    materials = [slot.material for slot in obj.material_slots if slot.material is not None]
    if not materials:
        materials = [_plain_skin(obj)]
    for material in materials:
        existing = skin_node(material)
        if existing is not None:
            group = existing.node_tree
            break
    for material in materials:
        if material.library is not None and skin_node(material) is None:
            raise SkinError(
                f"Material '{material.name}' of '{obj.name}' belongs to {material.library.filepath}: make it local "
                "(Object > Relations > Make Local > ... and Materials) or make the skin in that file"
            )
    if group is None:
        group = next((g for g in skin_groups() if g.library is None), None) or new_group()
    for material in materials:
        node = skin_node(material)
        if node is None:
            _insert(material, group)
        elif node.node_tree != group:
            node.node_tree = group
    return group


def skin_node(material: bpy.types.Material) -> bpy.types.Node | None:
    """The material's node that is a skin group."""
    tree = blender_version.shader_tree(material)
    if tree is None:
        return None
    return next((n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup" and is_skin_group(n.node_tree)), None)


def remove_from_material(material: bpy.types.Material) -> None:
    """Takes the group out again and joins what it stood between."""
    tree = blender_version.shader_tree(material)
    node = skin_node(material)
    while node is not None:
        before = node.inputs[0].links[0].from_socket if node.inputs[0].is_linked else None
        after = [link.to_socket for link in node.outputs[0].links]
        for socket in after:
            if before is not None:
                tree.links.new(before, socket)
        tree.nodes.remove(node)
        node = skin_node(material)


def _insert(material: bpy.types.Material, group: bpy.types.NodeTree) -> None:
    plain = blender_version.shader_tree(material) is None
    tree = blender_version.ensure_shader_tree(material)
    if plain:
        _color_principled(tree, tuple(material.diffuse_color), material.roughness)
    outputs = {o for o in (tree.get_output_node(t) for t in ("ALL", "CYCLES", "EEVEE")) if o is not None}
    if not outputs:
        outputs = {tree.nodes.new("ShaderNodeOutputMaterial")}
    for output in outputs:
        surface = output.inputs["Surface"]
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.location = (output.location.x, output.location.y)
        output.location.x += 200
        if surface.is_linked:
            tree.links.new(surface.links[0].from_socket, node.inputs["Surface"])
        tree.links.new(node.outputs["Shader"], surface)


def _plain_skin(obj: bpy.types.Object) -> bpy.types.Material:
    if obj.data.library is not None:
        raise SkinError(f"'{obj.name}' has no material, and its mesh belongs to a library: give it one there")
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
