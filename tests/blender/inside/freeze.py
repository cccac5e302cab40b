"""Frozen skins: a Blender without the add-on renders the same pixels; what cancels, undoes and mends."""

import subprocess

import bpy
import numpy as np
import skinglow_blender as sb

from inside.scenes import add_light, camera_above, read_exr, render_settings
from inside.switched_off import python_command

FIRST, LAST = 3, 6
RENDER = """
import bpy, os, sys
bpy.ops.wm.open_mainfile(filepath={file!r})
assert not any(name.startswith("skinglow") for name in sys.modules) and not hasattr(bpy.types.Object, "skinglow")
bpy.context.scene.render.filepath = {pictures!r}
bpy.ops.render.render(animation=True)
os._exit(0)
"""


def ball(name, location, material=None):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.8, location=location)
    obj = bpy.context.object
    obj.name = obj.data.name = name
    obj.data.materials.append(material or bpy.data.materials.new(name))
    if bpy.app.version < (5, 0, 0):
        obj.active_material.use_nodes = True
    return obj


def moving_scene(work, **settings):
    """Two skins of one material and one of its own; lights, strengths and scale are keyed, one light is for renders."""
    key, final = add_light("Key", energy=40.0), add_light("Final", "SPOT", (0.2, 0.4, 1.0), 90.0, (2.0, 2.0, 1.0))
    final.hide_viewport = True
    skins = [ball("A", (-1.0, 0.0, 0.0)), ball("C", (0.0, -1.5, 0.0))]
    skins.insert(1, ball("B", (1.0, 0.0, 0.0), skins[0].active_material))
    for obj in skins:
        x = np.array([v.co.x for v in obj.data.vertices])
        sb.make_skin(obj, thickness=4.0 + 4.0 * x, unit_mm=10.0, **settings)
    node = next(n for n in skins[2].active_material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
    for frame in range(FIRST - 1, LAST + 2):
        node.inputs["Strength"].default_value = 0.5 + 0.3 * frame
        node.inputs["Strength"].keyframe_insert("default_value", frame=frame)
        key.location, key.data.color = (0.5 * frame - 2.0, 0.3, 1.5), (1.0 / frame, 0.1 * frame, 0.5)
        key.keyframe_insert("location", frame=frame)
        key.data.keyframe_insert("color", frame=frame)
        skins[0].skinglow.strength, skins[1].scale = 1.0 + frame, [1.0 + 0.05 * frame] * 3
        skins[0].keyframe_insert("skinglow.strength", frame=frame)
        skins[1].keyframe_insert("scale", frame=frame)
    camera_above(4.5, (0.0, -0.5, 5.0))
    scene = render_settings(24, 24)
    scene.frame_start, scene.frame_end = FIRST, LAST
    scene.frame_set(FIRST)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "scene.blend"))
    return skins


def render_here(folder):
    bpy.context.scene.render.filepath = f"{folder}/####"
    bpy.ops.render.render(animation=True)
    return pictures_of(folder)


def pictures_of(folder, first=FIRST, last=LAST):
    return np.array([read_exr(folder / f"{frame:04d}.exr") for frame in range(first, last + 1)])


def render_without_add_on(work, folder, last=LAST):
    """Saves the file and renders it in a Blender of its own."""
    bpy.ops.wm.save_mainfile()
    code = RENDER.format(file=bpy.data.filepath, pictures=f"{work / folder}/####")
    subprocess.run(python_command(work, code), check=True, capture_output=True, timeout=300)
    return pictures_of(work / folder, FIRST, last)


def assert_frozen_as_live(work, **settings):
    skins = moving_scene(work, **settings)
    live = render_here(work / "live")
    # Frames differ, and so do the skins.
    assert len(np.unique(live.reshape(len(live), -1), axis=0)) == len(live) and live.max() > 0.05
    frozen = sb.freeze()
    assert [set(each.skins) for each in frozen] == [{"A", "B"}, {"C"}], frozen
    for each in frozen:
        names = sorted(path.name for path in each.folder.iterdir())
        assert names == [f"light_{n:04d}.exr" for n in range(FIRST, LAST + 1)]
    np.testing.assert_array_equal(render_without_add_on(work, "without"), live)
    np.testing.assert_array_equal(render_here(work / "with"), live)
    assert all(sb.health(obj) == [] for obj in skins), [sb.health(obj) for obj in skins]
    assert sorted(sb.unfreeze()) == ["A", "B", "C"]
    np.testing.assert_array_equal(render_here(work / "again"), live)
    assert not [image for image in bpy.data.images if image.source == "SEQUENCE"]


def check_per_object_in_the_paper_mode(work):
    assert_frozen_as_live(work, mode="paper")


def check_per_object_in_the_physical_mode(work):
    assert_frozen_as_live(work, mode="physical")


def check_per_pixel(work):
    world = bpy.data.worlds.new("World")
    world.color = (0.1, 0.2, 0.1)
    bpy.context.scene.world = world
    assert_frozen_as_live(work, mode="physical", weights="surface")


def check_fixed_mode_with_persistent_data_and_motion_blur(work):
    bpy.context.scene.render.use_persistent_data = True
    bpy.context.scene.render.use_motion_blur = True
    assert_frozen_as_live(work, mode="existing")
