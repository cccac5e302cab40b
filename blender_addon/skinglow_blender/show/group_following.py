# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps skins and the node groups in their materials consistent when materials are reassigned.

A skin has its row in the images of one node group. If it, or a mesh that it shares, gets a material with another group
(an appended one, say), that group would show it the row of another skin.
"""

import bpy

from .lut_image import SLOTS, delete_images, images_of, shown_image, skin_groups
from .skin_material import skin_node


def may_change_groups(update: bpy.types.DepsgraphUpdate) -> bool:
    """Whether a reported change may have assigned another material to a skin; moving it or a light cannot."""
    if isinstance(update.id, bpy.types.Object):
        return update.id.type == "MESH" and (update.is_updated_geometry or update.is_updated_shading)
    return isinstance(update.id, bpy.types.Material)


def follow_materials() -> None:
    """Moves each skin to the group in its materials, and all materials of a skin to one group."""
    skins = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.skinglow.enabled]
    moved = True
    while moved:
        moved = any([_follow(obj) for obj in skins])


def _follow(obj: bpy.types.Object) -> bool:
    """Returns whether anything was moved. The number of groups only decreases, so the iteration terminates."""
    nodes = [node for slot in obj.material_slots if slot.material for node in (skin_node(slot.material),) if node]
    if not nodes:
        return False
    # A group from a library takes precedence: its material cannot be changed.
    nodes.sort(key=lambda node: node.id_data.library is None)
    group = nodes[0].node_tree
    moved = False
    for node in nodes:
        if node.node_tree != group and node.id_data.library is None:
            node.node_tree, moved = group, True
    if obj.skinglow.group != group:
        obj.skinglow.group, obj.skinglow.row, moved = group, -1, True
        obj.update_tag(refresh={"OBJECT"})
    return moved


def remove_orphans() -> None:
    """Deletes lookup images that no group uses: Blender never does, because they point to each other."""
    shown = {image for group in skin_groups() for image in [shown_image(group), *images_of(group)]}
    ours = [i for i in bpy.data.images if i.library is None and getattr(i.skinglow, SLOTS[0]) is not None]
    delete_images([image for image in ours if image not in shown])
