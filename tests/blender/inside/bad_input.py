"""What people do wrong: the message says what, where and how, and nothing is lost."""

import sys

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.identity import key_of
from skinglow_blender.session import SESSION

from inside.scenes import add_light, assert_shows, camera_above, depsgraph, paper_table, patch

THIN = [0.0, 1.0, 2.0, 3.0]


def refused(kind, text, function, *args, **kwargs):
    try:
        function(*args, **kwargs)
    except kind as error:
        assert text in str(error), str(error)
    else:
        raise AssertionError(f"nothing was said of {text}")


def check_objects_that_cannot_be_skins(_work):
    empty = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    bpy.context.scene.collection.objects.link(empty)
    refused(sb.SkinError, "'Nothing' has no faces", sb.make_skin, empty)
    refused(sb.SkinError, "'Lamp' is not a mesh", sb.make_skin, add_light())
    flat = patch("Flat")
    flat.scale.x = 0.0
    depsgraph()
    refused(sb.SkinError, "'Flat' has scale 0", sb.make_skin, flat)
    for obj in (empty, flat):
        assert not obj.skinglow.enabled and not obj.material_slots
    assert not bpy.data.node_groups and not bpy.data.images
    refused(sb.SkinError, "is not a skin", sb.lut, flat, depsgraph())


def check_names_in_place_of_what_they_name(_work):
    """It was 'str' object has no attribute 'type', whatever was called."""
    obj = patch("Face")
    sb.make_skin(obj, thickness=THIN)
    graph = depsgraph()
    name = "obj is the text 'Face'; give an object: bpy.data.objects['Face']"
    for function in (sb.make_skin, sb.health, sb.bake_thickness, sb.remove_skin, sb.set_medium):
        refused(ValueError, f"{function.__name__}: {name}", function, "Face")
    for function in (sb.lut, sb.light_report, sb.state_of):
        refused(ValueError, name, function, "Face", graph)
        refused(ValueError, "give bpy.context.evaluated_depsgraph_get()", function, obj, bpy.context)
    refused(ValueError, "obj is [bpy.data.objects['Face']], of type list; give an object", sb.make_skin, [obj])
    refused(ValueError, "image is the text 'x.png'; give an image: bpy.data", sb.thickness_from_image, obj, "x.png")
    refused(ValueError, "material is the text 'Skin'; give a material", sb.show_light_by, "Skin", "skinglow")
    for function in (sb.freeze, sb.unfreeze):
        refused(ValueError, "objects is one Object; give a list: [bpy.data.objects['Face']]", function, obj)
        refused(ValueError, "objects is the text 'Face'; give an object", function, ["Face"])
        refused(ValueError, "objects is the text 'Face'; give an object", function, "Face")
    refused(ValueError, "depsgraph is ", sb.update, bpy.context)
    refused(ValueError, "depsgraph is ", sb.export_povray, bpy.context.scene, "x")
    refused(ValueError, "scene is the text 'Scene'; give a scene", sb.render_batch, "x", scene="Scene")
    assert obj.skinglow.enabled


def check_settings(_work):
    obj = patch()
    refused(ValueError, "has no setting 'color'", sb.make_skin, obj, thickness=THIN, color=1)
    refused(ValueError, "preset = 'lihgt' is not allowed: it has to be one of", sb.make_skin, obj, preset="lihgt")
    refused(ValueError, "mode = 'magic'", sb.make_skin, obj, thickness=THIN, mode="magic")
    refused(sb.SkinError, "4 vertices", sb.make_skin, obj, thickness=[1.0])
    refused(sb.SkinError, "negative or not finite", sb.make_skin, obj, thickness=[0, 1, 2, np.nan])
    refused(sb.SkinError, "no image is selected", sb.make_skin, obj, thickness=THIN, mode="paper", base="image")


def check_missing_image_keeps_the_last_good_lookup(work):
    key = add_light()
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    before = sb.lut(obj, depsgraph())
    image = bpy.data.images.new("Gone", 8, 1)
    image.source = "FILE"
    image.filepath = str(work / "gone.png")
    obj.skinglow.base_image = image
    obj.skinglow.base = "IMAGE"
    graph = depsgraph()
    assert "check that its file" in SESSION.faults[key_of(bpy.data.objects["Patch"])]
    np.testing.assert_array_equal(sb.lut(obj, graph)[:1], before[:1])
    refused(sb.SkinError, "check that its file", sb.update, graph)
    obj.skinglow.base = "BUILTIN"
    assert_shows(obj, paper_table([key]))
    assert not SESSION.faults


def check_absent_core(_work):
    """Without the compiled package: words, no exception out of a handler, the last lookup stays, and back again."""
    key = add_light()
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    before = sb.lut(obj, depsgraph())
    kept = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == "skinglow"}
    sys.modules["skinglow"] = None
    try:
        key.data.color = (0.0, 0.0, 1.0)
        graph = depsgraph()
        assert "compiled core" in SESSION.faults[key_of(bpy.data.objects["Patch"])]
        np.testing.assert_array_equal(sb.lut(obj, graph), before)
        refused(sb.SkinError, "compiled core", sb.update, graph)
        refused(sb.SkinError, "compiled core", sb.make_skin, patch("Other"))
    finally:
        del sys.modules["skinglow"]
        sys.modules.update(kept)
    key.location.z = 2.0
    assert_shows(obj, paper_table([key]))


def check_lights_that_the_core_refuses(_work):
    """A light of infinite power is a fault in words that names it; taken away, all is well."""
    key, wild = add_light("Key"), add_light("Wild")
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    before = sb.lut(obj, depsgraph())
    wild.data.energy = float("inf")
    graph = depsgraph()
    assert "Wild" in SESSION.faults[key_of(bpy.data.objects["Patch"])], SESSION.faults
    np.testing.assert_array_equal(sb.lut(obj, graph), before)
    bpy.data.objects.remove(wild)
    assert_shows(obj, paper_table([key]))


def check_open_mirrored_and_messy_meshes(_work):
    """Open, non-manifold and mirrored meshes get thicknesses that are finite and not negative."""
    open_mesh = patch("Open")
    sb.make_skin(open_mesh)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(3.0, 0.0, 0.0))
    ball = bpy.context.object
    plain = sb.make_skin(ball, unit_mm=10.0).thickness_mm
    np.testing.assert_allclose(plain, 10.0, rtol=0.05)
    ball.scale = (-1.0, 1.0, 1.0)
    depsgraph()
    np.testing.assert_allclose(sb.make_skin(ball).thickness_mm, plain, rtol=0.02)
    fin = bpy.data.meshes.new("Fin")
    fin.from_pydata(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (9, 9, 9)], [], [(0, 1, 2), (0, 1, 3), (0, 1, 4)]
    )
    messy = bpy.data.objects.new("Fin", fin)
    bpy.context.scene.collection.objects.link(messy)
    low, high = sb.make_skin(messy).thickness_mm
    assert 0.0 <= low <= high < np.inf


def check_no_lights(_work):
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    assert_shows(obj, paper_table([]))
    assert sb.light_report(obj, depsgraph()) == []


def check_export_without_camera_or_folder(work):
    obj = patch()
    graph = depsgraph()
    refused(sb.SkinError, "no skin", sb.export_povray, graph, work)
    sb.make_skin(obj, thickness=THIN, mode="paper")
    refused(sb.SkinError, "no camera", sb.export_povray, depsgraph(), work)
    camera_above()
    (work / "file").write_text("")
    refused(sb.SkinError, "Cannot write", sb.export_povray, depsgraph(), work / "file")


def check_what_the_report_says(_work):
    key, _dark, hidden = add_light("Key"), add_light("Dark", energy=0.0), add_light("Hidden")
    hidden.hide_viewport = True
    blind = add_light("Blind")
    blind.visible_diffuse = False
    obj = patch()
    for mode in ("paper", "physical"):
        sb.make_skin(obj, thickness=THIN, mode=mode)
        rows = {row["name"]: row for row in sb.light_report(obj, depsgraph())}
        assert rows["Key"]["share"] == 1.0 and rows["Key"]["reason"] == "" and rows["Key"]["distance"] == 1.0
        assert "zero power" in rows["Dark"]["reason"]
        assert rows["Hidden"]["reason"] == "disabled in viewports"
        assert "ray visibility" in rows["Blind"]["reason"]
        assert not rows["Dark"]["weight"].any()
    lights = [sg.Light(position=(0.0, 0.0, 1.0), color=tuple(key.data.color), power=10.0)]
    sb.make_skin(obj, thickness=THIN, mode="paper")
    rows = {row["name"]: row for row in sb.light_report(obj, depsgraph())}
    np.testing.assert_array_equal(rows["Key"]["weight"], sg.light_weights(lights, (0, 0, 0))[0])
