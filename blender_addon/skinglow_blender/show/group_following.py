# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps skins and the node groups in their materials consistent when materials are reassigned.

A skin has its row in the images of one node group. If it, or a mesh that it shares, gets a material with another group
(an appended one, say), that group would show it the row of another skin.
"""

import bpy

from ..identity import key_of
from ..read.file_skins import skins_of_file
from ..session import SESSION
from .group_sockets import nodes_with, replace_group
from .image_pairs import SLOTS, delete_images
from .inner_groups import delete_group, remove_unused
from .lut_image import FROZEN_PROPERTY, ROWS, images_of, skin_groups
from .skin_material import skin_node, skin_nodes
from .tile_image import TILES


def changes_groups(material: bpy.types.Material) -> bool:
    """Whether a material that was reported to have changed may have other skin node groups than before."""
    key, groups = key_of(material), frozenset(key_of(node.node_tree) for node in skin_nodes(material))
    before = SESSION.material_groups.get(key)
    SESSION.material_groups[key] = groups
    return before != groups


def follow_materials() -> bool:
    """Moves each skin to the group in its materials, and all materials of a skin to one group.

    Returns whether anything was moved.
    """
    skins = skins_of_file()
    again, moved = merge_copies(), True
    while moved:
        moved = any([_follow(obj) for obj in skins])
        again = again or moved
    return again


def merge_copies() -> bool:
    """Has nodes with a copied group use the one that it was copied from; returns whether there were some.

    The copy shows the images of the other, in which its skins would take the rows of the other's. What users choose is
    not in the group but in its nodes, and stays. A copy of a library's group was made local on purpose: make_whole.
    """
    owners: dict[bpy.types.Image, bpy.types.NodeTree] = {}
    merged = False
    for group in sorted(skin_groups(), key=lambda group: group.library is None):
        images = images_of(group)
        if FROZEN_PROPERTY in group or not images:
            continue
        owner = owners.setdefault(images[0], group)
        if owner == group or owner.library != group.library:
            continue
        for node in nodes_with(group):
            if node.id_data.library is None:
                replace_group(node, owner)
                merged = True
    return merged


def _follow(obj: bpy.types.Object) -> bool:
    """Returns whether anything was moved.

    Each is moved to a group that precedes its own in one order of all groups, so the iteration terminates.
    """
    nodes = [node for slot in obj.material_slots if slot.material for node in (skin_node(slot.material),) if node]
    if not nodes:
        return False
    nodes.sort(key=_precedence)
    group = nodes[0].node_tree
    moved = False
    for node in nodes:
        if node.node_tree != group and node.id_data.library is None:
            replace_group(node, group)
            moved = True
    if obj.skinglow.group != group:
        obj.skinglow.group, obj.skinglow.row, moved = group, -1, True
        obj.update_tag(refresh={"OBJECT"})
    return moved


def _precedence(node: bpy.types.Node) -> tuple[bool, bool, str]:
    """A group from a library comes first, as its material cannot be changed; then a frozen one, which stays so."""
    return node.id_data.library is None, FROZEN_PROPERTY not in node.node_tree, node.node_tree.name_full


def remove_orphans() -> None:
    """Deletes groups that nothing uses, and lookup images that no group uses; right after a file is loaded.

    Loading drops what has no user, but what that alone used only the next time: a material that was taken out of its
    slot, then its group, then the inner ones of that. Images it never drops, because they point to each other.
    """
    for group in skin_groups():
        if group.library is None and group.users == 0:
            delete_group(group)
    remove_unused(list(bpy.data.node_groups))
    kinds = [(kind, group) for kind in (ROWS, TILES) for group in skin_groups()]
    shown = {image for kind, group in kinds for image in [kind.shown(group), *kind.all_of(group)]}
    ours = [i for i in bpy.data.images if i.library is None and getattr(i.skinglow, SLOTS[0]) is not None]
    delete_images([image for image in ours if image not in shown])
