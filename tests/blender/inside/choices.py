"""What new skins begin with: the operator's properties, the preferences, presets, and points that move."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender import preferences
from skinglow_blender.live import file_upgrade
from skinglow_blender.show.lut_image import GROUP_PROPERTY
from skinglow_blender.thickness import thickness_attribute
from skinglow_blender.tissue_presets import PRESETS, TISSUE_SLIDERS
from skinglow_blender.ui import measuring_operators

from inside.bad_input import refused
from inside.scenes import add_light, depsgraph, patch

sb.register()

THIN = [0.0, 1.0, 2.0, 3.0]


def selected(obj):
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    obj.skinglow.unit_mm = 10.0
    return obj


def ball():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5)
    return selected(bpy.context.object)


def check_make_is_physical_and_can_be_adjusted(_work):
    obj = ball()
    bpy.ops.skinglow.make()
    assert obj.skinglow.mode == "PHYSICAL" and obj.skinglow.preset == "LIGHT"
    bpy.ops.skinglow.make(mode="EXISTING", preset="DARK", weights="SURFACE")
    settings = obj.skinglow
    assert (settings.mode, settings.preset, settings.weights) == ("EXISTING", "DARK", "SURFACE")
    # What is not adjusted stays, and nothing is remembered for the next skin.
    bpy.ops.skinglow.make()
    assert (settings.mode, settings.preset, settings.weights) == ("EXISTING", "DARK", "SURFACE")
    obj.select_set(False)
    other = ball()
    bpy.ops.skinglow.make()
    assert (other.skinglow.mode, other.skinglow.preset) == ("PHYSICAL", "LIGHT")


def check_unit_of_make_is_that_of_the_thickness(_work):
    obj = ball()
    bpy.ops.skinglow.make(unit_mm=20.0)
    assert obj.skinglow.unit_mm == 20.0
    values = np.array([each.value for each in obj.data.attributes["skinglow_thickness"].data])
    assert 10.0 < values.max() < 20.5, values.max()
    assert not sb.health(obj)


def check_adjusting_make_shows_what_is_and_measures_once(_work):
    """Adjust Last Operation undoes and does again at each change of a slider."""
    ball()
    bpy.ops.ed.undo_push(message="before")
    calls, measure = [], thickness_attribute.measure
    of_new_skins = measuring_operators.of_new_skins
    measuring_operators.of_new_skins = lambda: {"mode": "PAPER", "weights": "OBJECT"}
    thickness_attribute.measure = lambda *each: calls.append(each) or measure(*each)
    try:
        bpy.ops.skinglow.make("EXEC_DEFAULT", True)
        last = bpy.context.window_manager.operators[-1]
        assert last.bl_idname == "SKINGLOW_OT_make"
        assert (last.mode, last.weights, last.preset, last.unit_mm) == ("PAPER", "OBJECT", "LIGHT", 10.0)
        stored = thickness_attribute.read(bpy.context.object.data)[0].copy()
        for preset in ("DARK", "EAR"):
            bpy.ops.ed.undo()
            assert not bpy.context.object.skinglow.enabled
            bpy.ops.skinglow.make("EXEC_DEFAULT", True, mode="PHYSICAL", preset=preset)
            settings = bpy.context.object.skinglow
            assert (settings.mode, settings.weights, settings.preset) == ("PHYSICAL", "OBJECT", preset)
        np.testing.assert_array_equal(thickness_attribute.read(bpy.context.object.data)[0], stored)
        assert len(calls) == 1
        bpy.context.object.skinglow.unit_mm = 20.0
        bpy.ops.skinglow.make("EXEC_DEFAULT", True)
        assert len(calls) == 2
    finally:
        measuring_operators.of_new_skins, thickness_attribute.measure = of_new_skins, measure


def check_names_that_scripts_may_use(_work):
    obj = patch()
    for given, mode in {"fixed": "EXISTING", "tinted": "PAPER", "existing": "EXISTING", "physical": "PHYSICAL"}.items():
        assert sb.make_skin(obj, thickness=THIN, mode=given).mode == mode
    for given, weights in {"per_pixel": "SURFACE", "auto": "SURFACE", "per_object": "OBJECT"}.items():
        assert sb.make_skin(obj, weights=given).weights == weights


def check_preset_is_what_the_sliders_show(_work):
    obj = patch()
    sb.make_skin(obj, thickness=THIN)
    settings = obj.skinglow
    for name, _label, _description in PRESETS[1:]:
        settings.preset = name
        assert settings.preset == name
    before = [getattr(settings, slider) for slider in TISSUE_SLIDERS]
    settings.preset = "CUSTOM"
    assert before == [getattr(settings, slider) for slider in TISSUE_SLIDERS]
    settings.melanin_fraction = 0.2345
    assert settings.preset == "CUSTOM"
    settings.preset = "LIGHT"
    settings.keyframe_insert("melanin_fraction", frame=1)
    settings.melanin_fraction = 0.3
    settings.keyframe_insert("melanin_fraction", frame=11)
    bpy.context.scene.frame_set(1)
    light = sb.lut(obj, depsgraph())
    bpy.context.scene.frame_set(11)
    assert settings.preset == "CUSTOM"
    add_light()
    sb.update(depsgraph())
    assert not np.array_equal(sb.lut(obj, depsgraph()), light)


def menu_label(name):
    return getattr(bpy.types, name).bl_label


def check_user_presets_are_saved_and_removed(_work):
    obj = selected(patch())
    sb.make_skin(obj, thickness=THIN, preset="dark", melanin_fraction=0.123)
    bpy.ops.skinglow.add_skin_preset(name="Tanned")
    obj.skinglow.preset = "LIGHT"
    paths = bpy.utils.preset_paths("skinglow/skin")
    files = [path for folder in paths for path in bpy.path.module_names(folder)]
    assert [name for name, _path in files] == ["tanned"] or [name for name, _path in files] == ["Tanned"], files
    menu = "SKINGLOW_MT_skin_presets"
    bpy.ops.script.execute_preset(filepath=files[0][1], menu_idname=menu)
    assert obj.skinglow.melanin_fraction == np.float32(0.123) and obj.skinglow.preset == "CUSTOM"
    # The menu names another one by now, which is not the user's.
    bpy.ops.skinglow.apply_preset(preset="LIGHT")
    refused(RuntimeError, "comes with Skinglow", bpy.ops.skinglow.add_skin_preset, remove_active=True)
    assert bpy.utils.preset_find(menu_label(menu), "skinglow/skin", display_name=True)
    bpy.ops.script.execute_preset(filepath=files[0][1], menu_idname=menu)
    bpy.ops.skinglow.add_skin_preset(name="Tanned", remove_active=True)
    assert not [path for folder in paths for path in bpy.path.module_names(folder)]


def check_reference_object_and_bone_move_the_point(_work):
    obj = patch()
    add_light(energy=10.0, location=(0.0, 0.0, 3.0))
    target = bpy.data.objects.new("Target", None)
    bpy.context.scene.collection.objects.link(target)
    target.location = (0.0, 0.0, 1.0)
    depsgraph()
    state = sb.make_skin(obj, thickness=THIN, reference_object=target)
    assert obj.skinglow.reference == "OBJECT" and state.point == (0.0, 0.0, 1.0), state.point
    near = sb.lut(obj, depsgraph())
    target.location.z = -1.0
    # The handler has seen it.
    assert (sb.lut(obj, depsgraph())[0] < near[0]).all()
    assert sb.update(depsgraph()) == []

    data = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("Ear")
    bone.head, bone.tail = (0.0, 0.0, 2.0), (0.0, 0.0, 3.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    depsgraph()
    state = sb.make_skin(obj, reference_object=rig, reference_bone="Ear")
    assert state.point == (0.0, 0.0, 2.0), state.point
    rig.pose.bones["Ear"].location = (0.0, -1.0, 0.0)
    assert sb.update(depsgraph()) == []
    report = sb.light_report(obj, depsgraph())
    assert abs(report[0]["distance"] - 2.0) < 1e-5, report
    assert not sb.health(obj)
    obj.skinglow.reference_bone = "Nose"
    assert "missing" in str(sb.health(obj)[0])
    obj.skinglow.reference_bone = ""
    bpy.data.objects.remove(rig)
    assert "missing" in str(sb.health(obj)[0])


def check_older_files_keep_their_mode(_work):
    """Tinted was the default, which files do not store."""
    obj = patch()
    state = sb.make_skin(obj, thickness=THIN)
    assert state.mode == "PHYSICAL"
    obj.skinglow.property_unset("mode")
    obj.skinglow.group[GROUP_PROPERTY] = 2
    file_upgrade.upgrade()
    assert obj.skinglow.mode == "PAPER"
    file_upgrade.upgrade()
    obj.skinglow.mode = "PHYSICAL"
    file_upgrade.upgrade()
    assert obj.skinglow.mode == "PHYSICAL"


def check_preferences_are_absent_for_scripts(_work):
    assert preferences.preferences() is None and preferences.follows_lights() and not preferences.of_new_skins()
