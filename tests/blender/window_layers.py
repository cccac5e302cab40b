"""Runs in a Blender with a window: turns it from view layer to view layer and waits until the lookup follows; renders
an animation while a Cycles view is open, with and without Lock Interface.

Usage: xvfb-run blender --factory-startup -P window_layers.py -- RESULT.json, which then holds true or what went wrong.
"""

import json
import os
import sys
import time
import traceback
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "blender_addon")]
sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from inside.rendered_frames import assert_frames, scene_with_moving_light  # noqa: E402
from inside.scenes import add_light, assert_fresh, paper_table, patch  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402

SECONDS = 60


def window():
    return bpy.context.window_manager.windows[0]


def steps():
    """Turns the window; yields while it waits for the add-on."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    scene = bpy.context.scene
    extra = bpy.data.collections.new("Extra")
    scene.collection.children.link(extra)
    lights = [add_light("Key", color=(1.0, 0.0, 0.0)), add_light("Fill", color=(0.0, 0.0, 1.0), collection=extra)]
    obj = patch()
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="paper")
    layers = [scene.view_layers[0], scene.view_layers.new("Second")]
    layers[1].layer_collection.children["Extra"].exclude = True
    # Back and forth again: by then both have been evaluated.
    for which in (1, 0, 1, 0):
        window().view_layer = layers[which]
        expected = paper_table(lights[: 2 - which])
        until = time.monotonic() + SECONDS
        while not np.allclose(sb.lut(obj, layers[which].depsgraph or layers[0].depsgraph), expected, rtol=1e-6):
            assert time.monotonic() < until, f"{layers[which].name} shows another layer's lookup"
            yield
    yield from two_windows(obj, layers, paper_table(lights))
    yield from animation_while_cycles_looks()


def two_windows(obj, layers, of_first):
    """Two windows on two view layers come to rest, and the first decides what both show, whichever is edited."""
    bpy.ops.wm.window_new_main()
    yield
    first, second = bpy.context.window_manager.windows
    first.view_layer, second.view_layer = layers
    for _ in range(10):
        yield
    for edited in (None, bpy.data.objects["Key"]):
        if edited is not None:
            edited.location.x += 1e-3
            of_first = None
            for _ in range(10):
                yield
        updates = SESSION.updates
        for _ in range(20):
            yield
        assert SESSION.updates == updates, f"{SESSION.updates - updates} updates with nothing edited"
        if of_first is not None:
            np.testing.assert_allclose(sb.lut(obj, layers[0].depsgraph), of_first, rtol=1e-6)
    assert not SESSION.faults, SESSION.faults


def animation_while_cycles_looks():
    """Each frame shows its own light while the view is turned, and the view its own afterwards."""
    first, second = bpy.context.window_manager.windows
    with bpy.context.temp_override(window=second):
        bpy.ops.wm.window_close()
    first.scene = bpy.data.scenes.new("Rendered")
    scene, obj = scene_with_moving_light()
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.frame_end = 3
    scene.cycles.samples = 1024
    area = next(area for area in first.screen.areas if area.type == "VIEW_3D")
    space = area.spaces.active
    space.shading.type = "RENDERED"
    ended = []
    bpy.app.handlers.render_complete.append(lambda *_: ended.append(True))
    for is_locked in (True, False):
        scene.render.use_lock_interface = is_locked
        folder = Path(sys.argv[-1]).parent / f"locked_{is_locked}"
        folder.mkdir()
        scene.render.filepath = f"{folder}/####"
        ended.clear()
        yield
        with bpy.context.temp_override(window=first):
            bpy.ops.render.render("INVOKE_DEFAULT", animation=True)
        until = time.monotonic() + SECONDS
        while not ended:
            assert time.monotonic() < until, "the animation does not end"
            space.region_3d.view_distance *= 1.01
            area.tag_redraw()
            yield
        yield
        assert_frames(folder, 2e-5, last=scene.frame_end)
        assert_fresh(obj)
        assert not SESSION.faults, SESSION.faults


def tick():
    try:
        next(running)
        return 0.1
    except StopIteration:
        outcome = True
    except BaseException:
        outcome = traceback.format_exc()
    Path(sys.argv[-1]).write_text(json.dumps(outcome))
    os._exit(0)


running = steps()
bpy.app.timers.register(tick, first_interval=0.5)
