"""Skins whose tiles cannot show their light: lit per pixel, said in words, and repaired."""

import bpy
import skinglow_blender as sb

from inside.scenes import depsgraph, patch
from inside.shape_scenes import assert_through, lobe, shape_skin, sun


def faults(obj):
    return " ".join(str(fault) for fault in sb.health(obj))


def is_through(obj):
    return obj.get("skinglow_tiles", (0.0,) * 4)[3] == 1.0


def check_modifiers_that_do_not_keep_faces(_work):
    sun()
    obj = lobe(levels=2)
    shape_skin(obj)
    assert is_through(obj) and not faults(obj)
    for kind, word, settings in (
        ("MIRROR", "Mirror", {}),
        ("REMESH", "Remesh", {"voxel_size": 0.7}),
    ):
        modifier = obj.modifiers.new(kind, kind)
        for name, value in settings.items():
            setattr(modifier, name, value)
        depsgraph()
        assert word in faults(obj) and not is_through(obj), (kind, faults(obj))
        assert sb.state_of(obj, depsgraph()).shape.reason is not None
        obj.modifiers.remove(modifier)
        depsgraph()
        assert is_through(obj) and not faults(obj), kind
    assert_through(obj)


def check_edited_faces(_work):
    sun()
    obj = lobe(levels=2)
    shape_skin(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=1)
    bpy.ops.object.mode_set(mode="OBJECT")
    depsgraph()
    assert not is_through(obj) and "edited" in faults(obj), faults(obj)
    sb.make_skin(obj, thickness=[3.0] * len(obj.data.vertices))
    assert is_through(obj)
    assert_through(obj)


def check_a_negative_scale_that_is_applied(_work):
    """Blender 5.2 turns the faces around then, which changes nothing of what they show."""
    sun()
    obj = lobe(levels=2)
    obj.scale = (-1.0, 1.0, 1.0)
    depsgraph()
    shape_skin(obj)
    assert_through(obj)
    apply_scale()
    assert is_through(obj) and not faults(obj), faults(obj)
    assert_through(obj)


def check_a_negative_scale_that_is_applied_in_another_mode(_work):
    """The texels are asked for later: found by random edits in 5.2."""
    sun()
    obj = lobe(levels=2)
    obj.scale = (-1.0, 1.0, 1.0)
    depsgraph()
    shape_skin(obj)
    sb.make_skin(obj, mode="paper", thickness=[1.0] * len(obj.data.vertices))
    apply_scale()
    obj.skinglow.mode = "PHYSICAL"
    depsgraph()
    assert is_through(obj) and not faults(obj), faults(obj)
    assert_through(obj)


def apply_scale():
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    depsgraph()


def check_a_mesh_that_is_turned_inside_out(_work):
    """By the same order of corners, but flesh is elsewhere: that is told."""
    sun()
    obj = lobe(levels=2)
    shape_skin(obj)
    for is_turned in (True, False):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.flip_normals()
        bpy.ops.object.mode_set(mode="OBJECT")
        depsgraph()
        assert ("edited" in faults(obj)) == is_turned, faults(obj)
    assert is_through(obj)
    assert_through(obj)


def check_lighting_is_chosen_and_left(_work):
    """A skin that becomes lit through its shape gets tiles; two skins of one material are lit in two ways."""
    sun()
    obj = lobe(levels=2)
    shape_skin(obj, weights="object")
    assert "skinglow_tiles" not in obj.data
    obj.skinglow.weights = "SHAPE"
    depsgraph()
    sb.update(depsgraph())
    assert_through(obj)
    other = lobe("Other", obj.material_slots[0].material, levels=2)
    other.location.z = 50.0
    shape_skin(other, weights="surface")
    assert is_through(obj) and not is_through(other)
    assert_through(obj)
    other.skinglow.weights = "SHAPE"
    depsgraph()
    sb.update(depsgraph())
    assert_through(other)
    obj.skinglow.weights = other.skinglow.weights = "OBJECT"
    depsgraph()
    assert not is_through(obj)
    sb.remove_skin(obj)
    sb.remove_skin(other)
    assert not [key for each in (obj, obj.data) for key in each.keys() if "skinglow" in key and key != "skinglow"]
    assert not [image.name for image in bpy.data.images if "Skinglow" in image.name]


def check_open_sheets_are_lit_per_pixel(_work):
    """They enclose no flesh; closed, they are lit through their shape."""
    sun()
    sheet = patch(size=6.0)
    shape_skin(sheet)
    depsgraph()
    assert not is_through(sheet) and "enclose no flesh" in faults(sheet), faults(sheet)
    assert sb.lut(sheet, depsgraph()).max() > 0.0
    assert sb.update(depsgraph()) == []
    vertices = [(x, y, z) for z in (0.0, -2.0) for x, y in ((-3, -3), (3, -3), (3, 3), (-3, 3))]
    sides = [(i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)]
    sheet.data.clear_geometry()
    sheet.data.from_pydata(vertices, [], [(0, 1, 2, 3), (7, 6, 5, 4), *sides])
    shape_skin(sheet, cell_mm=1.3)
    assert is_through(sheet) and not faults(sheet), faults(sheet)
