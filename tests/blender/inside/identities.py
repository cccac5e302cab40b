"""Things of one name, or whose names look like others': each keeps what is its own."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.batch import rigs
from skinglow_blender.identity import HAS_UID, key_of
from skinglow_blender.live.rebuilt import why_changed
from skinglow_blender.session import SESSION

from inside.scenes import BLOOD, add_light, camera_above, depsgraph, link, patch, render_settings
from inside.world_scenes import image_world

THIN = [0.0, 1.0, 2.0, 3.0]


def linked_copy(work, name):
    """A skin of that name from a library, half as large."""
    obj = patch(name, 1.0)
    add_light("Other light")
    sb.make_skin(obj, thickness=THIN, mode="physical")
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "library.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "library.blend"), link=True) as (_source, target):
        target.objects = [name]
    return link(target.objects[0])


def check_export_of_two_skins_of_one_name(work):
    linked = linked_copy(work, "Head")
    add_light()
    local = patch("Head")
    sb.make_skin(local, thickness=THIN, mode="physical")
    third = patch("head", 4.0)
    sb.make_skin(third, thickness=THIN, mode="physical")
    camera_above()
    assert linked.name == local.name == "Head"
    files = sb.export_povray(depsgraph(), work / "povray")
    assert len(set(files)) == len(files)
    folders = {path.parent for path in files}
    assert len({folder.name.casefold() for folder in folders}) == 3
    meshes = {(folder / "mesh.inc").read_text() for folder in folders}
    assert len(meshes) == 3


def check_local_object_of_the_full_name_of_a_linked_one(work):
    """Blender's own name for a linked object may be the plain name of another."""
    linked = linked_copy(work, "Head")
    light = add_light(location=(0.0, 0.0, -3.0))
    local = patch(linked.name_full, location=(0.0, 0.0, 2.0))
    assert local.name_full == linked.name_full
    sb.make_skin(local, thickness=THIN, mode="physical")
    for _ in range(2):
        assert not sb.update(depsgraph())
        distances = [sb.light_report(obj, depsgraph())[0]["distance"] for obj in (linked, local)]
        assert distances == [3.0, 5.0], distances
        near, far = (sb.lut(obj, depsgraph()) for obj in (linked, local))
        np.testing.assert_allclose(far, near * (3.0 / 5.0) ** 2, rtol=0.01)
        light.data.color = (1.0, 0.2, 0.1)
        sb.update(depsgraph())


def check_renaming_computes_nothing(_work):
    obj = patch("First")
    add_light()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    shown = sb.lut(obj, depsgraph())
    updates = SESSION.atlases.copy()
    obj.name = "Second"
    rebuilt = sb.update(depsgraph())
    assert not HAS_UID or not rebuilt
    assert SESSION.atlases == updates
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), shown)


def check_light_linking_by_object(work):
    """A light linked to the local of two objects of one name lights that one."""
    if bpy.app.version < (4, 0, 0):
        return
    linked = linked_copy(work, "Head")
    local = patch("Head")
    light = add_light()
    sb.make_skin(local, thickness=THIN, mode="physical")
    receivers = bpy.data.collections.new("Receivers")
    receivers.objects.link(local)
    light.light_linking.receiver_collection = receivers
    graph = depsgraph()
    sb.update(graph)
    assert sb.lut(local, graph).max() > 0.0
    assert sb.lut(linked, graph).max() == 0.0
    assert sb.light_report(linked, graph)[0]["reason"] == "light linking excludes this object"


def check_hidden_light_of_the_name_of_a_linked_one(work):
    """Each is listed with what is true of it."""
    linked_copy(work, "Head")
    with bpy.data.libraries.load(str(work / "library.blend"), link=True) as (_source, target):
        target.objects = ["Other light"]
    shown, hidden, apart = link(target.objects[0]), add_light("Other light"), bpy.data.collections.new("Apart")
    assert shown.name == hidden.name
    obj = patch("Local")
    sb.make_skin(obj, thickness=THIN, mode="physical")
    hidden.hide_set(True)

    def reasons():
        rows = sb.light_report(obj, depsgraph())
        assert [row["name"] for row in rows] == [shown.name] * 2
        return {row["object"]: row["reason"] for row in rows}

    assert reasons() == {key_of(shown): "", key_of(hidden): "hidden in the viewport"}

    def signatures():
        return SESSION.atlases[key_of(obj.skinglow.group), "VIEWPORT"].signatures

    whys = []
    for change in (lambda: hidden.hide_set(False), lambda: setattr(hidden.data, "energy", 7.0)):
        change()
        before = signatures()[key_of(obj)]
        depsgraph()
        whys.append(why_changed(before, signatures()[key_of(obj)]))
    assert whys == ["light 'Other light' added", "light 'Other light': power"], whys
    hidden.hide_set(True)
    bpy.context.scene.collection.children.link(apart)
    apart.objects.link(hidden)
    bpy.context.scene.collection.objects.unlink(hidden)
    bpy.context.view_layer.layer_collection.children["Apart"].exclude = True
    assert reasons()[key_of(hidden)] == "its collection is hidden or excluded from the view layer"


def check_rig_named_like_an_instance(work):
    """A light whose name contains " in ", next to one that is the first part of it."""
    obj = patch()
    for name in ("Sun", "Sun in Fog"):
        add_light(name)
    sb.make_skin(obj, thickness=THIN, mode="physical")
    camera_above()
    render_settings()
    done = sb.render_batch(work / "batch", frames=[1], rigs=["Sun in Fog", "Sun"])
    assert len(done.rendered) == 2 and not done.failed, done


def check_instance_of_a_light_in_a_rig(_work):
    """A light that only its instances show counts as shown, whatever its instancer is called."""
    obj = patch()
    inside = bpy.data.collections.new("Inside")
    light = add_light("Key in Box", collection=inside)
    instancer = link(bpy.data.objects.new("Far in Room", None))
    instancer.instance_type, instancer.instance_collection = "COLLECTION", inside
    sb.make_skin(obj, thickness=THIN, mode="physical")
    scene = bpy.context.scene
    ready = rigs.make_ready(scene, rigs.Rig("key", ("Key in Box",)))
    rigs.check_lights(ready, scene, {light.name})
    report = sb.light_report(obj, depsgraph())
    (row,) = (row for row in report if np.any(row["weight"]))
    assert (row["name"], row["object"]) == ("Key in Box in Far in Room", key_of(instancer))
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.skinglow.select_light(light=row["name"], key=row["object"]) == {"FINISHED"}
    assert instancer.select_get()


def check_make_on_the_linked_one_of_two_full_names(work):
    """The button acts on what is selected, not on the local object of that full name."""
    linked = linked_copy(work, "Head")
    add_light()
    local = patch(linked.name_full)
    for obj, chosen in ((linked, True), (local, False)):
        obj.select_set(chosen)
    bpy.context.view_layer.objects.active = linked
    try:
        bpy.ops.skinglow.make()
    except RuntimeError as error:
        assert linked.name in str(error), error
    assert linked.skinglow.enabled and not local.skinglow.enabled


def check_images_of_one_full_name(work):
    """A base lookup and a world of linked images, beside local ones that have their full names."""
    levels = {"Base": 0.25, "World": 0.5}
    for name, level in levels.items():
        image = bpy.data.images.new(name, 4, 4, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set([level, level, level, 1.0] * 16)
        image.pack()
        image.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "images.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "images.blend"), link=True) as (_source, target):
        target.images = list(levels)
    images = dict(zip(levels, target.images, strict=True))
    for image in images.values():
        black = bpy.data.images.new(image.name_full, 4, 4, float_buffer=True)
        assert black.name_full == image.name_full and image.library
    obj = patch()
    image_world(images["World"])
    sb.make_skin(obj, thickness=THIN, mode="paper", base="image", base_image=images["Base"])
    table = sb.lut(obj, depsgraph())
    np.testing.assert_allclose(table, np.tile(levels["Base"] * BLOOD, (4, 1)), rtol=1e-5)
    obj.skinglow.mode = "PHYSICAL"
    depsgraph()
    (row,) = (row for row in sb.light_report(obj, depsgraph()) if row["kind"] == "WORLD")
    assert np.all(np.asarray(row["weight"]) > 0.0), row
    assert sb.health(obj) == []
