"""Frozen light through the shape: a second sequence holds the tiles."""

import os
import signal
from pathlib import Path

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands.freezing import frozen_state
from skinglow_blender.live import shape_update
from skinglow_blender.show.tile_image import TILES

from inside.freeze import FIRST, ball, pictures_of, render_without_add_on
from inside.scenes import add_light, camera_above, render_settings

LAST = FIRST + 1


def render_here(folder):
    bpy.context.scene.render.filepath = f"{folder}/####"
    bpy.ops.render.render(animation=True)
    return pictures_of(folder, last=LAST)


def check_through_the_shape(work):
    """Of two skins of one material one is lit through its shape; frozen, and live again, they show the same."""
    key = add_light("Key", energy=40.0)
    through = ball("Through", (-1.0, 0.0, 0.0))
    by_table = ball("By Table", (1.0, 0.0, 0.0), through.active_material)
    for obj, weights in ((through, "shape"), (by_table, "object")):
        obj.scale = (1.0, 1.0, 0.3)
        sb.make_skin(obj, thickness=[4.0] * len(obj.data.vertices), unit_mm=10.0, weights=weights, cell_mm=1.2)
    for frame in (FIRST, LAST):
        key.location, key.data.color = (0.5 * frame - 2.0, 0.3, -1.5), (1.0 / frame, 0.1 * frame, 0.5)
        key.keyframe_insert("location", frame=frame)
        key.data.keyframe_insert("color", frame=frame)
        through.skinglow.strength = 1.0 + frame
        through.keyframe_insert("skinglow.strength", frame=frame)
    camera_above(4.5)
    scene = render_settings(24, 24)
    scene.frame_start, scene.frame_end = FIRST, LAST
    scene.frame_set(FIRST)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "shape.blend"))
    live = render_here(work / "live")
    assert live[:, :, :12].max() > 0.01 and live[:, :, 12:].max() > 0.01 and not np.array_equal(*live)
    (frozen,) = sb.freeze()
    names = sorted(path.name for path in frozen.folder.iterdir())
    assert names == [f"{what}_{n:04d}.exr" for what in ("light", "tiles") for n in (FIRST, LAST)], names
    np.testing.assert_array_equal(render_without_add_on(work, "without", LAST), live)
    np.testing.assert_array_equal(render_here(work / "with"), live)
    assert not sb.health(through) and not sb.health(by_table), (sb.health(through), sb.health(by_table))
    (frozen.folder / f"tiles_{FIRST:04d}.exr").rename(work / "away.exr")
    scene.frame_set(FIRST)
    sb.update(bpy.context.evaluated_depsgraph_get())
    assert any("missing" in str(fault) for fault in sb.health(through)), sb.health(through)
    sb.unfreeze()
    assert len(TILES.all_of(through.skinglow.group)) == 4
    np.testing.assert_array_equal(render_here(work / "again"), live)
    assert not [image for image in bpy.data.images if image.source == "SEQUENCE"]


def check_canceled_while_it_waits_for_light(work):
    """Ctrl-C ends what a frame waits for: nothing is left of it, by a script and by the button alike."""
    work = work / "canceled"
    work.mkdir()
    key = add_light("Key", energy=40.0, location=(0.0, 0.3, -1.5))
    obj = ball("Through", (0.0, 0.0, 0.0))
    obj.scale = (1.0, 1.0, 0.3)
    sb.make_skin(obj, thickness=[4.0] * len(obj.data.vertices), unit_mm=10.0, weights="shape", cell_mm=1.2)
    for frame in (FIRST, LAST):
        key.location.x = 0.5 * frame - 2.0
        key.keyframe_insert("location", frame=frame)
    camera_above(4.5)
    scene = render_settings(8, 8)
    scene.frame_start, scene.frame_end = FIRST, LAST
    scene.frame_set(FIRST)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "shape.blend"))
    go_on, asked, heard = shape_update.may_go_on, [], []

    def press_in_the_second_frame(fraction):
        if scene.frame_current == LAST:
            if not asked:
                os.kill(os.getpid(), signal.SIGINT)
            asked.append(fraction)
        return go_on(fraction)

    of_blender = signal.getsignal(signal.SIGINT) is None
    before = None if of_blender else signal.signal(signal.SIGINT, lambda number, _frame: heard.append(number))
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    try:
        for begin in (sb.freeze, lambda: bpy.ops.skinglow.freeze("EXEC_DEFAULT")):
            asked.clear()
            shape_update.may_go_on = press_in_the_second_frame
            try:
                begin()
                raise AssertionError("freezing went on")
            except (KeyboardInterrupt, RuntimeError) as error:
                assert isinstance(error, KeyboardInterrupt) or "KeyboardInterrupt" in str(error), error
            finally:
                shape_update.may_go_on = go_on
            assert len(asked) == 1 and scene.frame_current == FIRST, (asked, scene.frame_current)
            assert frozen_state(obj) is None and not list((Path(work) / "skinglow_frozen").iterdir())
            sb.update(bpy.context.evaluated_depsgraph_get())
            assert not sb.health(obj), sb.health(obj)
    finally:
        if not of_blender:
            signal.signal(signal.SIGINT, before)
    assert of_blender or heard == 2 * [signal.SIGINT]
    assert [each.skins for each in sb.freeze()] == [("Through",)]
