"""Which material slots are skin: chosen by scripts and buttons, kept, told where a chosen one cannot glow."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.skin_material import skin_node

from inside.bad_input import refused
from inside.povray_files import povray
from inside.scenes import add_light, black_material, camera_above, depsgraph, read_exr, render_settings, strips

NAMES = ("Skin", "Eyes", "Teeth", "Cloth")


def head(**settings):
    """Four strips, each of a material of its own."""
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    obj = strips(4, material=black_material(NAMES[0]))
    for name in NAMES[1:]:
        obj.data.materials.append(black_material(name))
    for i, polygon in enumerate(obj.data.polygons):
        polygon.material_index = i
    sb.make_skin(obj, thickness=[2.0] * 16, mode="physical", **settings)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def with_node(obj):
    return [slot.material.name for slot in obj.material_slots if skin_node(slot.material) is not None]


def glowing(work):
    """Which of the four strips glow in a render."""
    camera_above()
    scene = render_settings(4, 4)
    scene.render.filepath = str(work / "slots.exr")
    bpy.ops.render.render(write_still=True)
    return (read_exr(work / "slots.exr")[1, :, 0] > 1e-3).tolist()


def check_all_by_default(work):
    obj = head()
    assert with_node(obj) == list(NAMES) and sb.health(obj) == []
    assert glowing(work) == [True] * 4


def check_chosen_by_name_and_index(work):
    obj = head(slots=["Skin", 3])
    assert with_node(obj) == ["Skin", "Cloth"] and sb.health(obj) == []
    assert glowing(work) == [True, False, False, True]
    # Kept by any later call, changed by another choice.
    sb.make_skin(obj, thickness=[2.0] * 16, strength=2.0)
    assert with_node(obj) == ["Skin", "Cloth"]
    sb.make_skin(obj, thickness=[2.0] * 16, slots=[1])
    assert with_node(obj) == ["Eyes"]
    path = str(work / "slots.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Strips"]
    sb.make_skin(obj, thickness=[2.0] * 16)
    assert with_node(obj) == ["Eyes"]
    sb.remove_skin(obj)
    assert with_node(obj) == [] and all(slot.material.skinglow.is_skin for slot in obj.material_slots)


def check_a_slot_that_is_not_there(_work):
    obj = head(slots=["Skin"])
    for wrong in (["Hair"], [4], [-1], ["Skin", "Hair"]):
        refused(ValueError, "has the slots 0 'Skin', 1 'Eyes'", sb.make_skin, obj, thickness=[2.0] * 16, slots=wrong)
    refused(ValueError, "at least one slot", sb.make_skin, obj, thickness=[2.0] * 16, slots=[])
    refused(sb.SkinError, "16 vertices", sb.make_skin, obj, thickness=[2.0], slots=["Eyes"])
    assert with_node(obj) == ["Skin"]


def check_box_of_the_list(work):
    """Cleared, the node goes and the material is as it was; set, it comes back; other objects with it follow."""
    obj = head()
    eyes = bpy.data.materials["Eyes"]
    nodes = len(eyes.node_tree.nodes)
    eyes.skinglow.is_skin = False
    assert with_node(obj) == ["Skin", "Teeth", "Cloth"] and len(eyes.node_tree.nodes) == nodes - 1
    out = next(n for n in eyes.node_tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
    assert out.inputs["Surface"].links[0].from_node.bl_idname == "ShaderNodeEmission"
    assert glowing(work) == [True, False, True, True] and sb.health(obj) == []
    eyes.skinglow.is_skin = True
    assert with_node(obj) == list(NAMES) and glowing(work) == [True] * 4
    for name in NAMES:
        bpy.data.materials[name].skinglow.is_skin = False
    assert "None of its materials" in str(sb.health(obj)[0])
    refused(sb.SkinError, "is chosen as skin", sb.make_skin, obj, thickness=[2.0] * 16)


def check_a_new_material_is_told(work):
    """Put into a skin's slot it does not glow; Repair adds the node, clearing its box says that it is meant."""
    obj = head()
    obj.material_slots[1].material = black_material("New")
    obj.material_slots[2].material = black_material("Newer")
    depsgraph()
    assert [fault.what for fault in sb.health(obj)] == [
        f"Material '{name}' has no Skinglow node, so its faces do not glow" for name in ("New", "Newer")
    ]
    bpy.data.materials["Newer"].skinglow.is_skin = False
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert with_node(obj) == ["Skin", "New", "Cloth"] and sb.health(obj) == []
    assert glowing(work) == [True, True, False, True]


def check_thickness_of_what_is_not_skin_does_not_matter(_work):
    """Joined eyes have no thickness: a fault as long as they are skin."""
    obj = head()
    known = obj.data.attributes["skinglow_thickness_known"]
    for i in range(4, 8):
        known.data[i].value = 0.0
    obj.data.update()
    depsgraph()
    assert "not known at 25.0%" in str(sb.health(obj)[0])
    bpy.data.materials["Eyes"].skinglow.is_skin = False
    depsgraph()
    assert sb.health(obj) == []


def check_button(_work):
    """It keeps the choice; Adjust Last Operation, which calls it with what was changed, makes another one."""
    obj = head(slots=["Skin"])
    obj.skinglow.unit_mm = 10.0
    assert bpy.ops.skinglow.make() == {"FINISHED"}
    assert with_node(obj) == ["Skin"]
    choices = [{"name": name, "is_skin": name in ("Eyes", "Teeth")} for name in NAMES]
    assert bpy.ops.skinglow.make(slots=choices) == {"FINISHED"}
    assert with_node(obj) == ["Eyes", "Teeth"]
    none = [{"name": name, "is_skin": False} for name in NAMES]
    refused(RuntimeError, "at least one slot", bpy.ops.skinglow.make, slots=none)
    assert with_node(obj) == ["Eyes", "Teeth"]


def check_linked_material_is_left_out(work):
    """A library's material without the node cannot be skin; the others of the object can."""
    black_material("Eyes")
    bpy.data.materials["Eyes"].use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "eyes.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "eyes.blend"), link=True) as (_source, target):
        target.materials = ["Eyes"]
    obj = strips(2, material=black_material("Skin"))
    obj.data.materials.append(target.materials[0])
    refused(sb.SkinError, "belongs to", sb.make_skin, obj, thickness=[2.0] * 8, slots=["Skin", "Eyes"])
    sb.make_skin(obj, thickness=[2.0] * 8)
    assert with_node(obj) == ["Skin"] and sb.health(obj) == []
    obj.data.materials[0] = target.materials[0]
    refused(sb.SkinError, "belongs to", sb.make_skin, obj, thickness=[2.0] * 8)


def check_numbers_are_those_of_one_material(work):
    """Each strip's light is that of a skin of one material."""
    head()
    glowing(work)
    several = read_exr(work / "slots.exr")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    sb.make_skin(strips(4, material=black_material()), thickness=[2.0] * 16, mode="physical")
    glowing(work)
    np.testing.assert_array_equal(read_exr(work / "slots.exr"), several)


def check_povray_export(work):
    """The light of what is not skin is left out there too, and its unknown thickness does not matter."""
    obj = head(slots=["Skin", "Teeth"], strength=20.0)
    known = obj.data.attributes["skinglow_thickness_known"]
    for i in range(4, 8):
        known.data[i].value = 0.0
    obj.data.update()
    camera_above()
    render_settings(40, 40)
    sb.export_povray(depsgraph(), work / "povray", surface=False)
    povray(work / "povray")
    shown = read_exr(work / "povray" / "scene.exr")[20, 5::10, 0]
    assert shown[0] > 0.1 and shown[2] > 0.1 and max(shown[1], shown[3]) < 3e-3 * shown[0], shown
