"""What is told of frozen skins that are out of date, what is refused, and what batches do with them."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.blender_version import new_group_socket
from skinglow_blender.commands.freezing import frozen_state
from skinglow_blender.commands.health import quick_faults
from skinglow_blender.read.scene_reading import ROW_PROPERTY

from inside.bad_input import refused
from inside.freeze_and_back import small_scene
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr

sb.register()


def told(obj):
    depsgraph()
    return [fault.what for fault in quick_faults(obj)]


def check_live_update_leaves_it_alone_and_health_tells(work):
    work = work / "live_update_leaves_it_alone_and_health_tells"
    obj, key = small_scene(work)
    (frozen,) = sb.freeze()
    shown, row = sb.lut(obj, depsgraph()), tuple(obj[ROW_PROPERTY])
    assert told(obj) == []
    key.data.color = (0.0, 1.0, 0.0)
    assert told(obj) == ["Its lights, position or settings changed after it was frozen"]
    assert bpy.ops.skinglow.update() == {"FINISHED"}
    obj.skinglow.strength = 5.0
    sb.update(depsgraph())
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), shown)
    assert tuple(obj[ROW_PROPERTY]) == row
    key.data.color, obj.skinglow.strength = (1.0, 1.0, 1.0), 1.0
    assert told(obj) == []
    obj.location.x = 1.0
    assert len(told(obj)) == 1
    obj.location.x = 0.0
    bpy.context.scene.frame_set(7)
    assert told(obj) == ["It is frozen from frame 1 to 3: frame 7 shows frame 3"]
    bpy.context.scene.frame_set(2)
    assert told(obj) == []
    (frozen.folder / "light_0002.exr").unlink()
    assert "light_0002.exr is missing" in told(obj)[0]
    refused(sb.SkinError, "is missing", sb.lut, obj, depsgraph())
    # Another session knows as much.
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    assert "light_0002.exr is missing" in told(bpy.data.objects["Patch"])[0]
    bpy.context.scene.frame_set(3)
    assert told(bpy.data.objects["Patch"]) == []


def check_refused(work):
    work = work / "refused"
    work.mkdir()
    obj = patch(material=black_material())
    refused(sb.SkinError, "There is no skin to freeze", sb.freeze)
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    refused(sb.SkinError, "has no camera", sb.freeze)
    camera_above()
    refused(sb.SkinError, "Save the file first", sb.freeze)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "refused.blend"))
    refused(sb.SkinError, "reversed", sb.freeze, first=3, last=2)
    refused(sb.SkinError, "is not a skin", sb.freeze, [patch("Other")])
    assert not list(work.glob("skinglow_frozen/*"))
    sb.freeze(last=2)
    refused(sb.SkinError, "frozen already", sb.freeze)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    refused(RuntimeError, "frozen already", bpy.ops.skinglow.freeze)
    bpy.ops.skinglow.unfreeze()
    refused(RuntimeError, "Select a frozen skin", bpy.ops.skinglow.unfreeze)
    # Never over what is there: a farm may be reading it.
    (again,) = sb.freeze(last=2)
    assert again.folder.name == "Patch_2"


def check_names_that_folders_cannot_tell_apart(work):
    """Frozen together, each skin has a folder of its own."""
    work = work / "alike"
    obj, _key = small_scene(work)
    other = patch("patch", location=(3.0, 0.0, 0.0), material=black_material("Other"))
    sb.make_skin(other, thickness=[3.0] * 4, mode="paper")
    before = [sb.lut(each, depsgraph()) for each in (obj, other)]
    frozen = sb.freeze()
    assert sorted(each.folder.name for each in frozen) in (["Patch", "patch_2"], ["Patch_2", "patch"]), frozen
    assert told(obj) == [] and told(other) == []
    for each, lut in zip((obj, other), before, strict=True):
        np.testing.assert_allclose(sb.lut(each, depsgraph()), lut, rtol=1e-3)


def check_view_layers_that_differ(work):
    work = work / "view_layers_that_differ"
    obj, _key = small_scene(work)
    extra = bpy.data.collections.new("Extra")
    bpy.context.scene.collection.children.link(extra)
    add_light("Fill", collection=extra)
    second = bpy.context.scene.view_layers.new("Second")
    sb.freeze()
    sb.unfreeze()
    second.layer_collection.children["Extra"].exclude = True
    refused(sb.SkinError, "view layers light it differently", sb.freeze)
    assert frozen_state(obj) is None
    second.use = False
    sb.freeze()


def check_an_object_that_was_not_frozen_does_not_glow_by_mistake(work):
    work = work / "an_object_that_was_not_frozen_does_not_glow_by_mistake"
    obj, _key = small_scene(work)
    sb.freeze()
    other = patch("Other", location=(2.0, 0.0, 0.0), material=obj.active_material)
    refused(sb.SkinError, "frozen, but not with this object", sb.make_skin, other, thickness=[0.0] * 4)
    assert tuple(other[ROW_PROPERTY]) == (0.0,) * 4
    # A new material does not get the frozen nodes, and its skin is live.
    free = patch("Free", location=(0.0, 2.0, 0.0), material=black_material("Free"))
    sb.make_skin(free, thickness=[0.0] * 4, mode="paper")
    assert frozen_state(free) is None and frozen_state(obj) is not None


def check_batch(work):
    work = work / "batch"
    obj, key = small_scene(work)
    sb.freeze()
    obj.select_set(True)
    done = sb.render_batch(work / "batch", "1-3")
    assert len(done.rendered) == 3 and not done.failed
    assert len(sb.render_batch(work / "batch", "1-3").kept) == 3
    refused(sb.SkinError, "Frame 4 is not among its frozen ones, 1 to 3", sb.render_batch, work / "more", "2-5")
    refused(sb.SkinError, "do not follow light rigs", sb.render_batch, work / "rigs", "1", ["Key"])
    key.data.energy, key.data.color = 3.0, (1.0, 0.0, 0.0)
    refused(sb.SkinError, "changed after it was frozen", sb.render_batch, work / "changed", "1")
    expected = pictures_of_batch(work / "batch", 3)
    sb.unfreeze()
    key.data.energy, key.data.color = 10.0, (1.0, 1.0, 1.0)
    sb.render_batch(work / "live", "1-3")
    np.testing.assert_array_equal(pictures_of_batch(work / "live", 3), expected)


def pictures_of_batch(folder, last):
    return np.array([read_exr(folder / "scene" / f"{frame:04d}.exr") for frame in range(1, last + 1)])


def check_deleted_sequence_is_repaired(work):
    work = work / "deleted_sequence_is_repaired"
    if bpy.app.version[:2] == (5, 0):
        return  # crashes over any image that another one's custom property points to, also without the add-on
    obj, _key = small_scene(work)
    before = sb.lut(obj, depsgraph())
    sb.freeze()
    bpy.data.images.remove(next(image for image in bpy.data.images if image.source == "SEQUENCE"))
    assert told(obj)
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == [] and frozen_state(obj) is None
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)


def check_materials_that_share_a_group_of_the_artist(work):
    """Their skins have one node, and are frozen together; a skin of a material of its own stays live."""
    obj, _key = small_scene(work / "artist")
    free = patch("Free", location=(0.0, 3.0, 0.0), material=black_material("Free"))
    sb.make_skin(free, thickness=[0.0] * 4, mode="paper")
    skin_group = obj.skinglow.group
    shared = bpy.data.node_groups.new("Shared", "ShaderNodeTree")
    new_group_socket(shared, "Shader", "Shader", "OUTPUT", "")
    inner, out = shared.nodes.new("ShaderNodeGroup"), shared.nodes.new("NodeGroupOutput")
    inner.node_tree = skin_group
    shared.links.new(inner.outputs["Shader"], out.inputs[0])
    names = []
    for i in range(2):
        material = black_material(f"Shared {i}")
        tree = material.node_tree
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = shared
        output = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
        tree.links.new(node.outputs[0], output.inputs["Surface"])
        other = patch(f"Sharing {i}", location=(3.0 * i, -3.0, 0.0), material=material)
        sb.make_skin(other, thickness=[0.0] * 4, mode="paper")
        names.append(other.name)
    (frozen,) = sb.freeze([bpy.data.objects[names[0]]])
    assert sorted(frozen.skins) == names
    assert [frozen_state(bpy.data.objects[name]) is not None for name in (*names, "Free", "Patch")] == [True] * 2 + [
        False
    ] * 2
    assert all(sb.health(bpy.data.objects[name]) == [] for name in (*names, "Free", "Patch"))
    assert sorted(sb.unfreeze()) == names


def check_what_belongs_to_a_library_is_frozen_there(work):
    """Linked objects are refused; one that is frozen shows its frames where it is linked, and is not thawed there."""
    small_scene(work / "library")
    for frozen in (False, True):
        if frozen:
            bpy.ops.wm.open_mainfile(filepath=str(work / "library" / "small.blend"))
            sb.freeze()
            bpy.ops.wm.save_mainfile()
        bpy.ops.wm.read_factory_settings(use_empty=True)
        with bpy.data.libraries.load(str(work / "library" / "small.blend"), link=True) as (_source, target):
            target.objects = ["Patch", "Camera"]
        for obj in target.objects:
            bpy.context.scene.collection.objects.link(obj)
        linked = target.objects[0]
        bpy.context.scene.camera = target.objects[1]
        bpy.ops.wm.save_as_mainfile(filepath=str(work / "library" / f"user_{frozen}.blend"))
        linked = next(obj for obj in bpy.data.objects if obj.name == "Patch")
        depsgraph()
        if frozen:
            assert frozen_state(linked).folder == work / "library" / "skinglow_frozen" / "Patch"
            refused(sb.SkinError, "unfreeze it there", sb.unfreeze)
            assert sb.lut(linked, depsgraph()).max() > 0.0
        else:
            refused(sb.SkinError, "belongs to", sb.freeze)
