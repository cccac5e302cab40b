"""Objects that share one mesh, and so one thickness: what differs between them is told once, and what is told can be
mended."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands.health import OWN_MESH
from skinglow_blender.thickness import thickness_attribute

from inside.bad_input import refused
from inside.measured_as_shown import middle
from inside.panel_faults import panel
from inside.scenes import camera_above, depsgraph, link, render_settings
from inside.skin_health import add_decimate, healthy_skin, remove_node, sculpt_one


def twins(**settings):
    """A skin that is measured, and a linked duplicate of it, selected both."""
    obj = healthy_skin()
    sb.make_skin(obj, **settings)
    other = link(obj.copy())
    other.name, other.location = "Twin", (0.1, 0.0, 0.0)
    other.select_set(True)
    depsgraph()
    assert other.data == obj.data and sb.health(obj) == sb.health(other) == []
    return obj, other


def thickness(obj):
    return float(np.median(thickness_attribute.read(obj.data)[0][middle(obj)]))


def make_single_user(obj):
    """As Object > Relations > Make Single User > Object & Data does."""
    for each in bpy.context.selected_objects:
        each.select_set(each == obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.make_single_user(object=True, obdata=True)
    assert bpy.ops.skinglow.measure_thickness() == {"FINISHED"}
    depsgraph()


def check_other_modifiers_are_told_once_and_mended(work):
    """As a hint, with the one remedy there is; Repair leaves the thickness to the object that it was measured for."""
    obj, other = twins()
    camera_above()
    render_settings(4, 4)
    before = thickness(obj)
    other.modifiers.new("Thicker", "DISPLACE").strength = 0.002
    depsgraph()
    for _ in range(3):
        assert sb.health(obj) == []
        (hint,) = sb.health(other)
        assert "is that of 'Plate'" in hint.what and hint.is_hint and hint.remedy == OWN_MESH, hint
        text, buttons = panel(other)
        assert "is that of 'Plate'" in text and "Make Single User" in text and buttons == [], (text, buttons)
        assert panel(obj) == ("", [])
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
        depsgraph()
    # What else is wrong with it is repaired all the same.
    remove_node(other)
    assert "None of its materials" in str(sb.health(other)[0])
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == [] and [fault.is_hint for fault in sb.health(other)] == [True]
    assert thickness(obj) == before
    done = sb.render_batch(work / "batch", frames=[1])
    assert len(done.rendered) == 1 and not done.failed
    make_single_user(other)
    assert other.data != obj.data and sb.health(obj) == sb.health(other) == []
    assert thickness(obj) == before and thickness(other) > before + 1.0


def check_the_panel_follows_the_other_ones_modifiers(_work):
    obj, other = twins()
    solid = other.modifiers.new("Thicker", "SOLIDIFY")
    depsgraph()
    assert "is that of 'Plate'" in panel(other)[0]
    decimate = obj.modifiers.new("Fewer", "DECIMATE")
    depsgraph()
    assert "modifiers were edited" in panel(other)[0] and "modifiers were edited" in panel(obj)[0]
    obj.modifiers.remove(decimate)
    other.modifiers.remove(solid)
    depsgraph()
    assert panel(obj) == panel(other) == ("", [])


def check_edits_of_the_mesh_are_repaired_for_all(_work):
    """They are a fault of each; repairing one object does it for those that are like it."""
    for other_too in (False, True):
        obj, other = twins()
        if other_too:
            add_decimate(other)
        sculpt_one(obj)
        depsgraph()
        for each in (obj, other):
            assert "mesh or its modifiers were edited" in str(sb.health(each)[0])
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
        depsgraph()
        hints = [fault for each in (obj, other) for fault in sb.health(each)]
        assert len(hints) == other_too and all(hint.is_hint for hint in hints), hints


def check_other_units_are_a_fault_until_the_mesh_is_its_own(work):
    """Its glow is wrong by that factor, so a batch refuses; Repair says what to do and moves the fault to nobody."""
    obj, other = twins(unit_mm=1000.0)
    camera_above()
    render_settings(4, 4)
    before = thickness(obj)
    other.skinglow.unit_mm = 500.0
    depsgraph()
    for _ in range(2):
        assert sb.health(obj) == []
        (fault,) = sb.health(other)
        assert "which is now 500 mm; it is that of 'Plate'" in fault.what and not fault.is_hint, fault
        assert fault.remedy == OWN_MESH and panel(other)[1] == []
        refused(RuntimeError, "Make Single User", bpy.ops.skinglow.repair)
    refused(sb.SkinError, "Make Single User", sb.render_batch, work / "units", frames=[1])
    make_single_user(other)
    assert sb.health(obj) == sb.health(other) == []
    assert thickness(obj) == before and abs(thickness(other) - before / 2.0) < 1e-3


def check_other_rays_are_mended_too(_work):
    obj, other = twins()
    other.skinglow.rays = 80
    depsgraph()
    (fault,) = sb.health(other)
    assert fault.remedy == OWN_MESH and sb.health(obj) == []
    make_single_user(other)
    assert sb.health(obj) == sb.health(other) == []


def check_units_of_scenes(_work):
    """A duplicate in another scene was measured by the unit of that one."""
    obj, other = twins()
    bpy.context.scene.collection.objects.unlink(other)
    second = bpy.data.scenes.new("Second")
    second.collection.objects.link(other)
    bpy.context.scene.unit_settings.scale_length = 0.5
    depsgraph()
    (fault,) = sb.health(obj)
    assert "now 500 mm; it is that of 'Twin'" in fault.what and fault.remedy == OWN_MESH, fault


def check_uneven_scales_are_told_once(_work):
    obj, other = twins()
    other.scale = (1.0, 2.0, 1.0)
    depsgraph()
    assert sb.health(obj) == []
    (hint,) = sb.health(other)
    assert "scaled unlike 'Plate'" in hint.what and hint.is_hint and hint.remedy == OWN_MESH
    make_single_user(other)
    assert sb.health(obj) == sb.health(other) == []


def check_a_modifier_hidden_to_work_faster_is_no_fault(_work):
    """What was measured is what the render shows. Measured while it was hidden, it is told once and Repair mends it."""
    obj = healthy_skin()
    smooth = obj.modifiers.new("Smooth", "SUBSURF")
    sb.make_skin(obj)
    before = thickness(obj)
    for shown in (False, True, False):
        smooth.show_viewport = shown
        depsgraph()
        assert sb.health(obj) == [] and panel(obj) == ("", []), shown
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == []
    smooth.show_viewport = True
    depsgraph()
    if sb.health(obj):
        assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == [] and abs(thickness(obj) - before) < 1e-3
    # Hidden in both: not the mesh that was measured.
    smooth.show_viewport = smooth.show_render = False
    depsgraph()
    assert "modifiers were edited" in str(sb.health(obj)[0])
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == []
