"""Settings are refused or kept: not clamped without a word, not lost by Reset, overrides or a failed call."""

import math

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.read.scene_reading import ROW_PROPERTY
from skinglow_blender.session import SESSION
from skinglow_blender.skin_settings import MEASURING_NAMES, SETTING_NAMES, SkinSettings

from inside.bad_input import refused
from inside.scenes import add_light, depsgraph, link, patch

THIN = [0.0, 1.0, 2.0, 3.0]


def values(obj):
    def plain(value):
        return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value

    return {name: plain(getattr(obj.skinglow, name)) for name in SETTING_NAMES}


def check_values_out_of_range(_work):
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical", unit_mm=25.0)
    before = values(obj)
    for name, value in (
        ("melanin_fraction", 5.0),
        ("size", 0),
        ("size", 10**12),
        ("unit_mm", -3.0),
        ("strength", math.nan),
        ("strength", math.inf),
        ("blood_weight", (1.0, math.nan, 1.0)),
        ("attenuation", (-1.0, 0.0, 1.0)),
    ):
        refused(ValueError, f"make_skin: {name} = ", sb.make_skin, obj, thickness=THIN, mode="paper", **{name: value})
        assert values(obj) == before, name


def check_failed_call_changes_nothing(_work):
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical", preset="dark")
    for melanin in (None, 0.2):
        if melanin is not None:
            obj.skinglow.melanin_fraction = melanin
        before = values(obj)
        refused(sb.SkinError, "4 vertices", sb.make_skin, obj, thickness=[1.0], mode="paper", preset="ear", strength=3)
        assert values(obj) == before


def check_preset_is_a_menu(_work):
    """A preset writes the sliders, which animation of the preset itself would not."""
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    refused(TypeError, "not animatable", obj.keyframe_insert, "skinglow.preset")
    assert obj.keyframe_insert("skinglow.melanin_fraction")


def check_how_thickness_is_measured_is_not_animated(_work):
    """It is measured once: keys would do nothing."""
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    for name in MEASURING_NAMES:
        refused(TypeError, "not animatable", obj.keyframe_insert, f"skinglow.{name}")


def check_what_decides_the_nodes_is_not_animated(_work):
    """No nodes can be added while rendering: frames showed the lighting that the viewport had when they began."""
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    for name in ("mode", "weights", "base", "size"):
        for act in (obj.keyframe_insert, obj.driver_add):
            refused(TypeError, "not animatable", act, f"skinglow.{name}")
        assert obj.skinglow.is_property_set(name) == (name == "mode")
    obj.skinglow.weights = "SURFACE"
    assert obj.skinglow.weights == "SURFACE"


def check_lengths_are_in_mm(_work):
    """The kind of length that Blender shows in mm."""
    sb.register()
    for operator in (bpy.ops.skinglow.bake_thickness, bpy.ops.skinglow.thickness_from_image, bpy.ops.skinglow.make):
        properties = operator.get_rna_type().properties
        white = properties["white_mm" if "white_mm" in properties else "unit_mm"]
        assert white.unit == "CAMERA", (white.identifier, white.unit)


def check_reset_keeps_how_it_was_measured(_work):
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical", unit_mm=25.0, rays=7, min_openness=0.3, strength=4.0)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.skinglow.reset() == {"FINISHED"}
    settings = obj.skinglow
    assert (settings.unit_mm, settings.rays, round(settings.min_openness, 3)) == (25.0, 7, 0.3)
    assert settings.strength == 1.0
    sb.remove_skin(obj)
    assert (settings.unit_mm, settings.rays) == (0.0, 64)


def check_deleted_row_property_comes_back(_work):
    obj, key = patch(), add_light()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    before = tuple(obj[ROW_PROPERTY])
    del obj[ROW_PROPERTY]
    obj.update_tag()
    key.data.energy = 20.0
    graph = depsgraph()
    assert tuple(obj[ROW_PROPERTY]) == before and not SESSION.faults
    assert sb.lut(obj, graph).max() > 0.0


def check_opened_file_is_not_modified(work):
    obj, key = patch(), add_light()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "saved.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(work / "saved.blend"))
    assert not [image.name for image in bpy.data.images if image.is_dirty]
    obj, key = bpy.data.objects["Patch"], bpy.data.objects["Lamp"]
    before = sb.lut(obj, depsgraph())
    key.data.energy *= 2.0
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), 2.0 * before, rtol=1e-6)


def check_library_overrides_keep_settings(work):
    obj = patch("Head")
    sb.make_skin(obj, thickness=THIN, mode="physical", melanin_fraction=0.02)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "library.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_light()
    with bpy.data.libraries.load(str(work / "library.blend"), link=True) as (_source, target):
        target.objects = ["Head"]
    override = link(target.objects[0]).override_create(remap_local_usages=True)
    override.skinglow.melanin_fraction, override.skinglow.strength = 0.3, 5.0
    shown = sb.lut(override, depsgraph())
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "shot.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(work / "shot.blend"))
    override = next(o for o in bpy.data.objects if o.override_library)
    assert (round(override.skinglow.melanin_fraction, 6), override.skinglow.strength) == (0.3, 5.0)
    np.testing.assert_array_equal(sb.lut(override, depsgraph()), shown)
    settings = SkinSettings.bl_rna.properties
    assert all(settings[name].is_overridable for name in (*SETTING_NAMES, "enabled", "group", "row"))


def check_buttons_refuse_what_is_lost(work):
    """Blender lets scripts change a library's objects, and forgets that when the file is opened again."""
    obj = patch("Head")
    sb.make_skin(obj, thickness=THIN, mode="paper", strength=3.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "heads.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "heads.blend"), link=True) as (_source, target):
        target.objects = ["Head"]
    linked = link(target.objects[0])
    depsgraph()
    linked.select_set(True)
    bpy.context.view_layer.objects.active = linked
    before = values(linked)
    for name in ("make", "reset", "remove", "apply_preset"):
        refused(RuntimeError, "changes here would be lost", getattr(bpy.ops.skinglow, name))
        assert values(linked) == before and linked.skinglow.enabled
    # An override keeps that it was reset, or is no skin.
    override = linked.override_create(remap_local_usages=True)
    depsgraph()
    bpy.context.view_layer.objects.active = override
    override.select_set(True)
    assert bpy.ops.skinglow.reset() == {"FINISHED"} and override.skinglow.strength == 1.0


def overridden(work, mesh=False):
    """An override of an object of a library; its mesh may be overridden too."""
    patch("Plain", material=bpy.data.materials.new("Surface"))
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "plain.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "plain.blend"), link=True) as (_source, target):
        target.objects = ["Plain"]
    override = link(target.objects[0]).override_create(remap_local_usages=True)
    if mesh:
        override.data = override.data.override_create()
    return override


def check_overridden_mesh_is_refused(work):
    """An override keeps no attribute that is added to it: it would be gone when the file is opened."""
    override = overridden(work, mesh=True)
    assert override.data.library is None and override.data.override_library
    for thickness in (None, THIN):
        words = "plain.blend and cannot keep a thickness"
        refused(sb.SkinError, words, sb.make_skin, override, thickness=thickness, mode="physical")
        assert not override.skinglow.enabled and not bpy.data.node_groups


def check_overridden_material_is_refused(work):
    """Nor a node, with a mesh of its own that keeps a thickness."""
    override = overridden(work)
    override.data = override.data.copy()
    override.data.materials[0] = bpy.data.materials["Surface"].override_create()
    material = override.material_slots[0].material
    assert material.library is None and material.override_library
    for slots in (None, [0]):
        words = "'Surface' of 'Plain' belongs to"
        refused(sb.SkinError, words, sb.make_skin, override, thickness=THIN, slots=slots, mode="physical")
        assert not override.skinglow.enabled and not bpy.data.node_groups


def check_linked_mesh_is_refused(work):
    """A thickness stored in a library's mesh would be gone when the file is opened again."""
    override = overridden(work)
    refused(sb.SkinError, "cannot keep a thickness", sb.make_skin, override, mode="physical")
    assert not override.skinglow.enabled and not bpy.data.node_groups
