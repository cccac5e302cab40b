"""Each thing that must agree for a skin, broken: it is told with its remedy, Repair mends it, a batch refuses it."""

import bpy
import numpy as np
import skinglow_blender as sb
from mathutils import Matrix
from skinglow_blender.read.measured_geometry import MOVING_NOTHING
from skinglow_blender.show.lut_image import images_of
from skinglow_blender.show.skin_material import remove_from_material, skin_node
from skinglow_blender.thickness.thickness_attribute import KNOWN_ATTRIBUTE

from inside.bad_input import refused
from inside.measured_as_shown import plate
from inside.panel_faults import panel
from inside.scenes import add_light, camera_above, depsgraph, link, render_settings


def healthy_skin():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_light()
    obj = plate()
    sb.make_skin(obj, mode="physical")
    assert sb.health(obj) == []
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def delete_group(obj):
    bpy.data.node_groups.remove(obj.skinglow.group)


def replace_material(obj):
    obj.material_slots[0].material = bpy.data.materials.new("New")


def remove_node(obj):
    remove_from_material(obj.material_slots[0].material)


def delete_attribute(obj):
    obj.data.attributes.remove(obj.data.attributes[KNOWN_ATTRIBUTE])


def sculpt(obj):
    for vertex in obj.data.vertices:
        if vertex.co.x > 0.0:
            vertex.co.z *= 2.0
    obj.data.update()


def sculpt_one(obj):
    """A vertex that the quick look does not sample."""
    obj.data.vertices[5].co.z += 0.003
    obj.data.update()


def add_solidify(obj):
    obj.modifiers.new("Thicker", "SOLIDIFY").thickness = 0.001


def add_decimate(obj):
    obj.modifiers.new("Fewer", "DECIMATE").ratio = 0.9


def change_unit(obj):
    obj.skinglow.unit_mm = 250.0


def change_unit_of_scene(_obj):
    bpy.context.scene.unit_settings.scale_length = 0.5


def change_rays(obj):
    obj.skinglow.rays = 80


def change_openness(obj):
    obj.skinglow.min_openness = 0.25


FAULTS = {
    delete_group: "node group was deleted",
    replace_material: "None of its materials has the Skinglow node",
    remove_node: "None of its materials has the Skinglow node",
    delete_attribute: "thickness is not known",
    sculpt: "mesh was edited",
    sculpt_one: "mesh or its modifiers were edited",
    add_solidify: "mesh or its modifiers were edited",
    add_decimate: "mesh or its modifiers were edited",
    change_unit: "one unit was 1000 mm, which is now 250 mm",
    change_unit_of_scene: "one unit was 1000 mm, which is now 500 mm",
    change_rays: "Rays or Min Sky Visibility were changed",
    change_openness: "Rays or Min Sky Visibility were changed",
}


def check_each_fault_is_told_and_repaired(_work):
    """By health and by the panel, which had shown that all was well."""
    for break_it, words in FAULTS.items():
        obj = healthy_skin()
        assert panel(obj) == ("", [])
        break_it(obj)
        depsgraph()
        found = [str(fault) for fault in sb.health(obj)]
        assert any(words in text for text in found), (break_it.__name__, found)
        text, buttons = panel(obj)
        assert words in text and buttons == ["skinglow.repair"], (break_it.__name__, text, buttons)
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
        assert sb.health(obj) == [], (break_it.__name__, sb.health(obj))
        depsgraph()
        assert panel(obj) == ("", []), break_it.__name__
        assert sb.lut(obj, depsgraph()).max() > 0.0


def check_deleted_images_come_back(_work):
    if bpy.app.version[:2] == (5, 0):
        return  # crashes over any image that another one's custom property points to, also without the add-on
    for slot in range(4):
        obj = healthy_skin()
        before = sb.lut(obj, depsgraph())
        bpy.data.images.remove(images_of(obj.skinglow.group)[slot])
        depsgraph()
        assert [fault.what for fault in sb.health(obj)] == ["An image of its lookup was deleted"]
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
        assert sb.health(obj) == []
        np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)


def check_no_false_alarm(_work):
    """Moved, turned, scaled, with hair and normals, given thicknesses: all is well."""
    obj = healthy_skin()
    for kind in sorted(MOVING_NOTHING):
        obj.modifiers.new(kind, kind)
        depsgraph()
        assert sb.health(obj) == [], kind
    assert {m.type for m in obj.modifiers} == MOVING_NOTHING
    obj.modifiers.clear()
    obj.location, obj.rotation_euler, obj.scale = (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), (2.0, 2.0, 2.0)
    depsgraph()
    assert sb.health(obj) == []
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    assert sb.health(obj) == []
    obj.data.transform(Matrix.Scale(0.5, 4))
    obj.data.update()
    assert sb.health(obj) == []
    # A unit that single precision rounds; it was refused as a change while measuring.
    assert bpy.ops.skinglow.make(unit_mm=25.4) == {"FINISHED"}
    assert sb.health(obj) == []
    sb.make_skin(obj, thickness=[1.0] * len(obj.data.vertices), mode="paper")
    sculpt(obj)
    change_unit(obj)
    change_rays(obj)
    assert sb.health(obj) == []


def check_uneven_scale_is_told(_work):
    """By the object, its parent or both at once; not where they cancel out, nor after measuring again."""
    obj = healthy_skin()
    parent = link(bpy.data.objects.new("Parent", None))
    obj.parent = parent
    for own, parents, is_told in (
        ((1, 1.2, 1), (1, 1, 1), True),
        ((1, 1, 1), (1, 1, 0.8), True),
        ((1, 2, 1), (1, 0.5, 1), False),
        ((3, 3, 3), (-1, 1, 1), False),
    ):
        obj.scale, parent.scale = own, parents
        depsgraph()
        found = sb.health(obj)
        assert len(found) == is_told, (own, parents, found)
        assert all("scaled unevenly" in fault.what and fault.is_hint for fault in found)
    obj.scale, parent.scale, parent.rotation_euler = (1, 1, 1.5), (1, 1, 1), (0.3, 0.2, 0.1)
    depsgraph()
    assert sb.health(obj)
    assert bpy.ops.skinglow.measure_thickness() == {"FINISHED"}
    assert sb.health(obj) == []
    obj.scale = (2, 2, 3)
    depsgraph()
    assert sb.health(obj) == []


def check_a_node_that_nothing_shows_is_told(_work):
    """Another shader on the output, another output, none; as an AOV alone it is shown; muted is a hint."""
    obj = healthy_skin()
    material = obj.material_slots[0].material
    tree, node = material.node_tree, skin_node(material)
    output = tree.get_output_node("ALL")
    new = tree.nodes.new("ShaderNodeBsdfDiffuse")

    def told_and_repaired():
        depsgraph()
        assert "'Skin' is not connected to its output" in str(sb.health(obj)[0]), sb.health(obj)
        assert "not connected" in panel(obj)[0]
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
        assert sb.health(obj) == [] and skin_node(material) == node
        return tree.get_output_node("ALL").inputs["Surface"].links[0].from_node

    tree.links.new(new.outputs[0], output.inputs["Surface"])
    assert told_and_repaired() == node and node.inputs["Surface"].links[0].from_node == new
    other = tree.nodes.new("ShaderNodeOutputMaterial")
    other.is_active_output = True
    assert told_and_repaired() == node
    for each in (output, other):
        tree.nodes.remove(each)
    assert told_and_repaired() == node
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(node.outputs["Shader"], add.inputs[0])
    tree.links.new(add.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    assert sb.health(obj) == []
    node.mute = True
    (hint,) = sb.health(obj)
    assert "is muted" in hint.what and hint.is_hint
    node.mute = False
    tree.links.new(new.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    assert sb.health(obj)
    tree.links.new(node.outputs["Light"], tree.nodes.new("ShaderNodeOutputAOV").inputs["Color"])
    assert sb.health(obj) == []


def check_what_a_view_layer_shows_instead_is_told(_work):
    """Material Override, Holdout and Shadow Catcher take the light away; they are what was asked for, no fault."""
    obj, layer = healthy_skin(), bpy.context.view_layer
    inner = bpy.data.collections.new("Inner")
    bpy.context.scene.collection.children.link(inner)
    inner.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    children = layer.layer_collection.children
    clay = bpy.data.materials.new("Clay")
    for owner, name, value, words in (
        (layer, "material_override", clay, "shows material 'Clay' in place of all others"),
        (obj, "is_holdout", True, "It is a holdout"),
        (children["Inner"], "holdout", True, "It is a holdout"),
        (obj, "is_shadow_catcher", True, "It is a shadow catcher"),
    ):
        before = getattr(owner, name)
        setattr(owner, name, value)
        depsgraph()
        (hint,) = sb.health(obj)
        assert words in hint.what and hint.is_hint, hint
        setattr(owner, name, before)
        depsgraph()
        assert sb.health(obj) == []


def check_what_cannot_be_repaired_stays_told(_work):
    obj = healthy_skin()
    remesh = obj.modifiers.new("New", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", 0.002
    depsgraph()
    assert "not known at 100.0% of the vertices shown" in str(sb.health(obj)[0])
    refused(RuntimeError, "apply it first", bpy.ops.skinglow.repair)


def check_batch_refuses(work):
    obj = healthy_skin()
    camera_above()
    render_settings(4, 4)
    remove_node(obj)
    refused(sb.SkinError, "'Plate': None of its materials", sb.render_batch, work / "batch", frames=[1])
    assert not (work / "batch").exists()
    obj.hide_render = True
    done = sb.render_batch(work / "batch", frames=[1])
    assert len(done.rendered) == 1 and not done.failed
