# SPDX-License-Identifier: GPL-3.0-or-later
"""Fills the Mask socket of a skin's materials from a vertex group or an image.

EEVEE, and Cycles before 4.5, cannot read vertex groups. So the weights are copied to an attribute of the mesh.
"""

import hashlib
import os
from collections.abc import Collection

import bpy
import numpy as np

from ..identity import library_of
from .skin_material import skin_input, skin_nodes

#: Custom property of the nodes that fill the socket.
MASK_PROPERTY = "skinglow_mask"
#: The attribute that holds a vertex group's weights is called so, followed by the group's name.
ATTRIBUTE_PREFIX = "skinglow_mask_"
#: Bytes of a name of an attribute that every Blender keeps; some cut longer ones, others refuse them.
LONGEST_NAME = 63


def attribute_of(group: str) -> str:
    """The name of the attribute that holds a vertex group's weights: a digest of names that Blender would cut."""
    name = ATTRIBUTE_PREFIX + group
    if len(name.encode()) <= LONGEST_NAME:
        return name
    return ATTRIBUTE_PREFIX + hashlib.sha256(group.encode()).hexdigest()[:32]


def fill_mask(material: bpy.types.Material) -> None:
    """Connects what the material's settings ask for; what an artist connected stays, and what a library has."""
    settings = material.skinglow
    if library_of(material) is not None:
        return
    for node in skin_nodes(material):
        if masked_by_artist(node):
            continue
        kind = None
        if settings.mask == "VERTEX_GROUP" and settings.mask_group:
            kind = "ShaderNodeAttribute"
        elif settings.mask == "IMAGE" and (settings.mask_image is not None or _image_is_deleted(node)):
            kind = "ShaderNodeTexImage"
        source = _source(node, kind)
        if kind == "ShaderNodeAttribute":
            source.attribute_type, source.attribute_name = "GEOMETRY", attribute_of(settings.mask_group)
            node.id_data.links.new(source.outputs["Fac"], node.inputs["Mask"])
        elif kind == "ShaderNodeTexImage":
            source.image = settings.mask_image
            node.id_data.links.new(source.outputs["Color"], node.inputs["Mask"])


def image_fault(material: bpy.types.Material) -> str:
    """What is wrong with the image by which a material is masked, in words; empty: nothing."""
    settings = material.skinglow
    nodes = [node for node in skin_nodes(material) if not masked_by_artist(node)]
    if settings.mask != "IMAGE" or not nodes:
        return ""
    image = settings.mask_image
    if image is None:
        if not any(map(_image_is_deleted, nodes)):
            return ""  # none was chosen yet
        return f"The image that masks material '{material.name}' was deleted"
    if image.source != "FILE" or image.packed_file is not None or image.has_data:
        return ""
    if os.path.exists(bpy.path.abspath(image.filepath, library=image.library)):
        return ""
    return f"The file of '{image.name}' is missing, the image that masks material '{material.name}'"


def _image_is_deleted(node: bpy.types.Node) -> bool:
    """Whether the mask of a skin's node was an image that is no more; its node stays until another is chosen."""
    links = node.inputs["Mask"].links
    source = links[0].from_node if links else None
    is_image = source is not None and source.bl_idname == "ShaderNodeTexImage" and MASK_PROPERTY in source
    return is_image and source.image is None


def masked_by_artist(node: bpy.types.Node) -> bool:
    """Whether something else than the settings is connected to the Mask of a skin's node."""
    socket = skin_input(node, "Mask")
    return (
        socket is None
        or node.id_data.library is not None
        or (socket.is_linked and MASK_PROPERTY not in socket.links[0].from_node)
    )


def remove_mask_nodes(material: bpy.types.Material) -> None:
    """Removes the nodes that the settings added."""
    for node in skin_nodes(material):
        if not masked_by_artist(node):
            _source(node, None)


def _source(node: bpy.types.Node, kind: str | None) -> bpy.types.Node | None:
    """The node of that kind that fills a skin node's Mask, made if there is none; any other of ours is removed."""
    tree, socket = node.id_data, node.inputs["Mask"]
    source = socket.links[0].from_node if socket.is_linked else None
    if source is not None and source.bl_idname != kind and MASK_PROPERTY in source:
        tree.nodes.remove(source)
        source = None
    if source is None and kind is not None:
        source = tree.nodes.new(kind)
        source[MASK_PROPERTY] = True
        source.label, source.location = "Skinglow Mask", (node.location.x - 320, node.location.y - 180)
    return source


def mask_groups(obj: bpy.types.Object) -> set[str]:
    """The vertex groups by which materials of an object are masked."""
    settings = (slot.material.skinglow for slot in obj.material_slots if slot.material is not None)
    return {s.mask_group for s in settings if s.is_skin and s.mask == "VERTEX_GROUP" and s.mask_group}


def store_masks(obj: bpy.types.Object) -> None:
    """Copies the weights of the vertex groups by which an object's mesh is masked to attributes, if they changed."""
    mesh = obj.data
    if mesh.library is not None or obj.mode == "EDIT":
        return
    # Other objects may show the mesh with other materials.
    names = {name for o in bpy.data.objects if o.data == mesh and o.skinglow.enabled for name in mask_groups(o)}
    wanted = {attribute_of(name): obj.vertex_groups[name].index for name in names & set(obj.vertex_groups.keys())}
    _remove_but(mesh, wanted.keys())
    for name, index in wanted.items():
        weights = _weights(mesh, index)
        attribute = mesh.attributes.get(name)
        if attribute is None:
            attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        stored = np.empty_like(weights)
        attribute.data.foreach_get("value", stored)
        if not np.array_equal(stored, weights):
            attribute.data.foreach_set("value", weights)
            mesh.update()


def _weights(mesh: bpy.types.Mesh, index: int) -> np.ndarray:
    weights = np.zeros(len(mesh.vertices), np.float32)
    for i, vertex in enumerate(mesh.vertices):
        for group in vertex.groups:
            if group.group == index:
                weights[i] = group.weight
    return weights


def remove_masks(mesh: bpy.types.Mesh) -> None:
    """Removes the attributes that `store_masks` added."""
    _remove_but(mesh, ())


def _remove_but(mesh: bpy.types.Mesh, kept: Collection[str]) -> None:
    """Removes them by name, one at a time: until 4.5 what refers to one refers to the next after a removal."""
    for name in [a.name for a in mesh.attributes if a.name.startswith(ATTRIBUTE_PREFIX)]:
        if name not in kept:
            mesh.attributes.remove(mesh.attributes[name])
