"""As always_right: the lookup is right after undo, load, append and link, and in other scenes and view layers."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.live import handlers
from skinglow_blender.show.lut_image import shown_image

from inside.always_right import THIN, skin
from inside.scenes import add_light, assert_fresh, assert_shows, depsgraph, fresh_table, link, paper_table, patch


def check_undo_and_redo(_work):
    key = add_light("Key")
    skin()
    bpy.ops.ed.undo_push(message="start")
    key.data.color = (1.0, 0.0, 0.0)
    depsgraph()
    bpy.ops.ed.undo_push(message="red")
    key.data.color = (0.0, 0.0, 1.0)
    key.location.z = 2.0
    depsgraph()
    bpy.ops.ed.undo_push(message="blue")
    assert_fresh(bpy.data.objects["Patch"])
    blue = sb.lut(bpy.data.objects["Patch"], depsgraph())
    bpy.ops.ed.undo()
    assert tuple(bpy.data.lights["Key"].color) == (1.0, 0.0, 0.0)
    assert_fresh(bpy.data.objects["Patch"])
    bpy.ops.ed.undo()
    assert_fresh(bpy.data.objects["Patch"])
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert_fresh(bpy.data.objects["Patch"])
    np.testing.assert_array_equal(sb.lut(bpy.data.objects["Patch"], depsgraph()), blue)


def check_undo_of_making_a_skin(_work):
    add_light("Key")
    patch("First")
    bpy.ops.ed.undo_push(message="plain")
    sb.make_skin(bpy.data.objects["First"], thickness=THIN, mode="paper")
    bpy.ops.ed.undo_push(message="skin")
    bpy.ops.ed.undo()
    assert not bpy.data.objects["First"].skinglow.enabled
    bpy.ops.ed.redo()
    assert_fresh(bpy.data.objects["First"])


def check_save_and_load(work):
    key = add_light("Key", color=(0.3, 0.6, 0.9))
    obj = skin()
    expected = sb.lut(obj, depsgraph())
    path = str(work / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    handlers.unregister()
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Patch"]
    # Before anything is computed: what was saved, as a Blender without the add-on has it.
    group = obj.skinglow.group
    shown = shown_image(group)
    assert shown.packed_file is not None
    pixels = np.empty(4 * shown.size[0] * shown.size[1], np.float32)
    shown.pixels.foreach_get(pixels)
    saved = pixels.reshape(shown.size[1], -1, 4)[obj.skinglow.row, :256, :3]
    np.testing.assert_array_equal(saved, expected)
    handlers.register()
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Patch"]
    assert_fresh(obj)
    key = bpy.data.objects["Key"]
    key.data.color = (1.0, 0.0, 0.5)
    assert_fresh(obj)
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), fresh_table(obj, depsgraph()))


def _library(work):
    add_light("Library lamp")
    skin("Library skin")
    depsgraph()
    path = str(work / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return path


def _load(path, linked):
    with bpy.data.libraries.load(path, link=linked) as (_source, target):
        target.objects = ["Library skin"]
    return bpy.data.objects["Library skin"]


def check_append(work):
    path = _library(work)
    own = skin("Own")
    key = add_light("Key", color=(0.1, 0.9, 0.4))
    appended = link(_load(path, linked=False))
    appended.location = (2.0, 0.0, 0.0)
    assert_fresh(own, appended)
    key.data.color = (0.9, 0.1, 0.4)
    assert_fresh(own, appended)


def check_linked_and_overridden_libraries(work):
    path = _library(work)
    own = skin("Own")
    key = add_light("Key", color=(0.1, 0.9, 0.4))
    linked = link(_load(path, linked=True))
    assert_fresh(own, linked)
    key.location.z = 2.5
    assert_fresh(own, linked)
    override = linked.override_create(remap_local_usages=True)
    override.location = (0.0, 2.0, 0.0)
    assert_fresh(own, override)
    key.data.color = (0.9, 0.1, 0.4)
    assert_fresh(own, override)


def check_materials_that_bring_another_node_group(work):
    """A skin that is given an appended skin's material, also by its mesh's other user, moves to what that shows."""
    path = _library(work)
    key = add_light("Key", color=(0.1, 0.9, 0.4))
    own = skin("Own")
    sharing = link(own.copy())
    sharing.location.x = 2.0
    appended = link(_load(path, linked=False))
    appended.location.y = 2.0
    skins = [own, sharing, appended]
    assert_fresh(*skins)
    assert own.skinglow.group != appended.skinglow.group
    own.material_slots[0].material = appended.material_slots[0].material
    assert_fresh(*skins)
    assert len({obj.skinglow.group for obj in skins}) == 1
    assert len({obj.skinglow.row for obj in skins}) == 3
    key.data.color = (0.9, 0.1, 0.4)
    assert_fresh(*skins)
    # The images that nobody shows any more go when the file is loaded again.
    for material in list(bpy.data.materials):
        if not material.users:
            bpy.data.materials.remove(material)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "merged.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(work / "merged.blend"))
    assert len([image for image in bpy.data.images if "Skinglow" in image.name]) == 8  # of rows and of tiles
    assert_fresh(*(bpy.data.objects[name] for name in ("Own", "Own.001", "Library skin")))


def check_two_scenes(_work):
    """Each scene has lights of its own and skins of its own."""
    first_scene = bpy.context.scene
    one = skin("One")
    add_light("First lamp", color=(1.0, 0.0, 0.0))
    assert_fresh(one)
    second_scene = bpy.data.scenes.new("Second")
    two = one.copy()
    second_scene.collection.objects.link(two)
    light = bpy.data.objects.new("Second lamp", bpy.data.lights.new("Second lamp", "POINT"))
    light.data.energy, light.location.z = 5.0, 3.0
    second_scene.collection.objects.link(light)
    layer = second_scene.view_layers[0]
    layer.update()
    graph = layer.depsgraph
    sb.update(graph)
    np.testing.assert_allclose(sb.lut(two, graph), fresh_table(two, graph), rtol=3e-6)
    first_scene.view_layers[0].update()
    np.testing.assert_allclose(sb.lut(one, depsgraph()), fresh_table(one, depsgraph()), rtol=3e-6)
    np.testing.assert_allclose(sb.lut(two, graph), fresh_table(two, graph), rtol=3e-6)


def check_scene_strips(_work):
    """The Sequencer's preview evaluates scenes that no window shows: their skins follow, but for those it shows too."""
    strips_of, window = bpy.context.scene, bpy.context.window_manager.windows[0]
    own = skin("Own")
    add_light("Own light", color=(1.0, 0.0, 0.0))
    scene = bpy.data.scenes.new("Strip")
    window.scene = scene
    inside = skin("Inside")
    key = add_light("Key", color=(0.0, 1.0, 0.0))
    scene.collection.objects.link(own)
    for frame in (1, 9):
        key.location.z = frame
        key.keyframe_insert("location", frame=frame)
    assert_fresh(inside)
    window.scene = strips_of
    assert_fresh(own)
    before = sb.lut(inside, depsgraph()).copy()
    scene.frame_set(9)
    np.testing.assert_array_equal(sb.lut(inside, depsgraph()), before)
    editor = strips_of.sequence_editor_create()
    (editor.strips if hasattr(editor, "strips") else editor.sequences).new_scene("Strip", scene, 1, 1)
    for frame in (9, 4):
        scene.frame_set(frame)
        graph = scene.view_layers[0].depsgraph
        np.testing.assert_allclose(sb.lut(inside, graph), fresh_table(inside, graph), rtol=3e-6)
        assert_fresh(own)


def check_frames_with_two_view_layers(_work):
    """frame_set evaluates both layers; shown is the one in the window, and the other after switching to it."""
    scene, window = bpy.context.scene, bpy.context.window_manager.windows[0]
    extra = bpy.data.collections.new("Extra")
    scene.collection.children.link(extra)
    key, fill = add_light("Key", color=(1.0, 0.0, 0.0)), add_light("Fill", color=(0.0, 0.0, 1.0), collection=extra)
    obj = skin()
    layers = [scene.view_layers[0], scene.view_layers.new("Second")]
    layers[1].layer_collection.children["Extra"].exclude = True
    for layer, objects in ((0, [key, fill]), (1, [key]), (0, [key, fill])):
        window.view_layer = layers[layer]
        sb.update(depsgraph())
        assert_shows(obj, paper_table(objects))
        for frame in (2, 3):
            scene.frame_set(frame)
            assert_shows(obj, paper_table(objects))
            assert sb.update(depsgraph()) == []
