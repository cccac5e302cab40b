"""What Blender calls to draw, and in timers, raises nothing: a fault is shown, or ends what needed it."""

from contextlib import contextmanager

import bpy
import skinglow_blender as sb
from skinglow_blender.commands import shown_in_render
from skinglow_blender.live import waiting
from skinglow_blender.session import SESSION
from skinglow_blender.ui import heat_map

from inside.bad_input import refused
from inside.scenes import add_light, camera_above, patch


@contextmanager
def broken(module, name):
    """Context manager in which a name of a module is one that nothing can be done with."""
    kept = getattr(module, name)
    setattr(module, name, None)
    try:
        yield
    finally:
        setattr(module, name, kept)


def check_faults_of_drawing_and_timers_are_shown(_work):
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4)
    bpy.context.window_manager.skinglow_heat_map = True
    heat_map._batches["Patch"] = ((), None)
    for name, call in (
        ("shown_skins", heat_map.draw_skins),
        ("shown_skins", heat_map.draw_legend),
        ("key_of", lambda: heat_map._on_change(None, "not a depsgraph")),
        ("_batches", lambda: heat_map._forget(None, None)),
    ):
        SESSION.faults.clear()
        with broken(heat_map, name):
            call()
        assert "Unexpected" in SESSION.faults.get("*", ""), call.__code__.co_firstlineno
    SESSION.faults.clear()
    with broken(waiting, "SESSION"):
        waiting._watch()
    assert "Unexpected AttributeError" in SESSION.faults["*"]


def check_a_fault_ends_freezing(work):
    """Without a word, the frame would be missing what the handler could not take."""
    add_light()
    camera_above()
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "faulty.blend"))
    with broken(shown_in_render, "_shows_the_same"):
        refused(sb.SkinError, "unexpected TypeError", shown_in_render.shown_in_render, bpy.context.scene)
    assert len(shown_in_render.shown_in_render(bpy.context.scene)) == 1
