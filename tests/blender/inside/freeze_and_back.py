"""Freezing that is canceled, killed, undone or out of date; what is refused, and what batches do with it."""

import signal
import subprocess
from pathlib import Path

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.commands.freezing import frozen_state

from inside.bad_input import refused
from inside.freeze import FIRST, LAST, moving_scene, pictures_of, render_without_add_on
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings
from inside.switched_off import python_command

sb.register()

KILLED = """
import os, signal, sys
sys.path += {folders!r}
import bpy, skinglow_blender as sb
sb.register()
bpy.ops.wm.open_mainfile(filepath={file!r})
sb.unfreeze()
sb.freeze(progress=lambda done: done < 0.3 or os.kill(os.getpid(), signal.SIGKILL))
"""


def small_scene(work, frames=(1, 3)):
    """A skin under a light that moves, saved."""
    work.mkdir(exist_ok=True)
    key = add_light("Key")
    for frame in range(frames[0], frames[1] + 1):
        key.location.z = 1.0 + 0.2 * abs(frame)
        key.keyframe_insert("location", frame=frame)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="paper")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    camera_above()
    scene = render_settings(8, 8)
    scene.frame_start, scene.frame_end = frames
    scene.frame_set(frames[0])
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "small.blend"))
    return obj, key


def check_canceled(work):
    work = work / "canceled"
    obj, _key = small_scene(work)
    shown = sb.lut(obj, depsgraph())
    bpy.context.scene.frame_set(2)
    told = []
    refused(sb.SkinError, "canceled", sb.freeze, progress=lambda done: told.append(done) or len(told) < 2)
    assert len(told) == 2 and bpy.context.scene.frame_current == 2
    assert not list((work / "skinglow_frozen").iterdir()) and frozen_state(obj) is None and sb.health(obj) == []
    bpy.context.scene.frame_set(1)
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), shown)
    assert bpy.context.scene.render.engine == "CYCLES"


def check_killed(work):
    """What was frozen before stays whole; of what was begun no file is cut off, and none is taken for complete."""
    work = work / "killed"
    work.mkdir()
    moving_scene(work, mode="paper")
    (first, second) = sb.freeze()
    expected = render_without_add_on(work, "before")
    folders = [str(Path(module.__file__).parents[1]) for module in (sb, sg)]
    code = KILLED.format(folders=folders, file=bpy.data.filepath)
    ended = subprocess.run(python_command(work, code), capture_output=True, timeout=300, check=False)
    assert ended.returncode == -signal.SIGKILL, ended
    parent = first.folder.parent
    complete = {first.folder, second.folder}
    left = set(parent.iterdir()) - complete
    assert len(left) == 2 and all(path.name.startswith(".") and path.name.endswith(".part") for path in left), left
    files = [file for folder in left for file in folder.glob("light_*.exr")]
    assert len(files) in (2, 4)
    assert {read_exr(file).shape[1] for file in files} == {256}
    np.testing.assert_array_equal(render_without_add_on(work, "after"), expected)
    bpy.context.scene.frame_set(FIRST)


def check_undone_and_redone(work):
    work = work / "undone_and_redone"
    small_scene(work)
    name = bpy.context.object.name

    def looks(frozen):
        obj = bpy.data.objects[name]
        sb.update(depsgraph())
        assert (frozen_state(obj) is not None) == frozen
        assert sb.health(obj) == []
        sequences = [image for image in bpy.data.images if image.source == "SEQUENCE" and image.users]
        assert len(sequences) == int(frozen)
        return sb.lut(obj, depsgraph())

    bpy.ops.ed.undo_push(message="before")
    live = looks(frozen=False)
    for operator, frozen in ((bpy.ops.skinglow.freeze, True), (bpy.ops.skinglow.unfreeze, False)):
        assert operator("EXEC_DEFAULT", True) == {"FINISHED"}
        for undone in (False, True, False):
            np.testing.assert_array_equal(looks(frozen != undone), live)
            if undone:
                bpy.ops.ed.redo()
            else:
                bpy.ops.ed.undo()
        bpy.ops.ed.redo()
        np.testing.assert_array_equal(looks(frozen), live)


def check_lights_that_come_later_need_more_nodes(work):
    """Per pixel: all frames are written for the nodes of the one with most lights."""
    work = work / "lights_that_come_later_need_more_nodes"
    work.mkdir()
    lights = [add_light(f"Light {i}", energy=30.0, location=(0.4 * i - 1.0, 0.3, -0.9 - 0.1 * i)) for i in range(5)]
    for light in lights[1:]:
        for frame, energy in ((2, 0.0), (3, 30.0)):
            light.data.energy = energy
            light.data.keyframe_insert("energy", frame=frame)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[2.0, 3.0, 4.0, 5.0], mode="physical", weights="surface", unit_mm=10.0)
    camera_above()
    scene = render_settings(8, 8)
    scene.frame_start, scene.frame_end = FIRST - 2, LAST - 2
    scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "later.blend"))
    sb.freeze()
    scene.render.filepath = f"{work}/frozen/####"
    bpy.ops.render.render(animation=True)
    sb.unfreeze()
    scene.render.filepath = f"{work}/live/####"
    bpy.ops.render.render(animation=True)
    frozen, live = (pictures_of(work / folder, FIRST - 2, LAST - 2) for folder in ("frozen", "live"))
    np.testing.assert_array_equal(frozen, live)
    assert live[3].mean() > 1.5 * live[0].mean() > 0.0


def check_frames_below_zero(work):
    work = work / "frames_below_zero"
    obj, _key = small_scene(work, (-2, 1))
    (frozen,) = sb.freeze(first=-2)
    assert sorted(path.name for path in frozen.folder.iterdir()) == [f"light_{n:04d}.exr" for n in range(1, 5)]
    tables = []
    for live in (False, True):
        if live:
            sb.unfreeze()
        for frame in range(-2, 2):
            bpy.context.scene.frame_set(frame)
            bpy.context.scene.render.filepath = str(work / f"{live}_{frame}.exr")
            bpy.ops.render.render(write_still=True)
            tables.append(read_exr(work / f"{live}_{frame}.exr"))
    np.testing.assert_array_equal(tables[:4], tables[4:])
    assert obj.skinglow.enabled


def check_appended_to_another_file(work):
    work = work / "appended_to_another_file"
    small_scene(work)
    sb.freeze()
    expected = [image.copy() for image in render_small(work, "one")]
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "small.blend"), link=False) as (_source, target):
        target.objects = ["Patch", "Camera"]
    for obj in target.objects:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.camera = bpy.data.objects["Camera"]
    render_settings(8, 8).frame_end = 3
    (work / "elsewhere").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "elsewhere" / "other.blend"))
    np.testing.assert_array_equal(render_small(work, "two"), expected)
    assert frozen_state(bpy.data.objects["Patch"]).folder == work / "skinglow_frozen" / "Patch"


def render_small(work, folder):
    bpy.context.scene.render.filepath = f"{work / folder}/####"
    bpy.ops.render.render(animation=True)
    return pictures_of(work / folder, 1, 3)
