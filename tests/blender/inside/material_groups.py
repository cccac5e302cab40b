"""Skins whose materials have several node groups, as after appending: they come to rest on one."""

import skinglow_blender as sb
from skinglow_blender.show.group_following import follow_materials
from skinglow_blender.show.skin_group import new_group
from skinglow_blender.show.skin_material import skin_node

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
