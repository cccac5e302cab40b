"""Skins whose materials have several node groups, as after appending: they come to rest on one."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.group_following import follow_materials
from skinglow_blender.show.inner_groups import LIGHT_NODE, inner_groups_of
from skinglow_blender.show.lut_image import images_of
from skinglow_blender.show.skin_group import new_group
from skinglow_blender.show.skin_material import skin_node

from inside.leaks import unused
from inside.scenes import add_light, assert_fresh, black_material, depsgraph, patch


def check_a_material_between_two_groups(_work):
    """Each of two skins has a material of its own group, and both have a third one: for ever they took it in turns."""
    add_light()
    first, second = patch("First", material=black_material("A")), patch("Second", material=black_material("B"))
    shared = black_material("Shared")
    for obj in (first, second):
        obj.data.materials.append(shared)
        sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="paper")
    other = new_group()
    skin_node(second.material_slots[0].material).node_tree = other
    follow_materials()
    depsgraph()
    assert first.skinglow.group == second.skinglow.group
    nodes = [skin_node(slot.material) for obj in (first, second) for slot in obj.material_slots]
    assert {node.node_tree for node in nodes} == {first.skinglow.group}
    assert_fresh(first, second)


def check_groups_that_are_left_are_gone_at_the_next_load(work):
    """Copies of a group, one that the materials of its skin left for the first one, and one of a material without use.

    Loading drops the one, and the material; found by random edits, which saw what these used stay for another load.
    """
    add_light()
    obj = patch(material=black_material("A"))
    obj.data.materials.append(black_material("B"))
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], weights="surface")
    node = skin_node(obj.material_slots[1].material)
    left, unshown = node.node_tree.copy(), node.node_tree.copy()
    node.node_tree = left
    skin_node(obj.material_slots[0].material.copy()).node_tree = unshown
    depsgraph()
    assert node.node_tree == obj.skinglow.group not in (left, unshown)
    assert images() == 8  # of rows and of tiles: copies show the same ones
    path = str(work / "left.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert unused() == 0 and len([tree for tree in bpy.data.node_groups if tree.name.startswith("Skinglow")]) == 1
    assert images() == 8
    assert sb.update(depsgraph()) == []


def images():
    return len([image for image in bpy.data.images if "Skinglow" in image.name])


def check_a_deleted_inner_group_comes_back(_work):
    """An update that needs it says so; Repair makes it, and the images stay."""
    add_light()
    obj = patch(material=black_material("A"))
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="physical", weights="object")
    group = obj.skinglow.group
    shown, before = images_of(group), sb.lut(obj, depsgraph())
    bpy.data.node_groups.remove(inner_groups_of(group)[LIGHT_NODE])
    obj.skinglow.weights = "SURFACE"
    depsgraph()
    (fault,) = sb.health(obj)
    assert "lacks a part" in fault.what
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == [] and images_of(group) == shown
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), before, rtol=1e-5)
