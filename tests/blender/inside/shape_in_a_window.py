"""What a window does, where a thread solves the light: here its answers are taken by hand."""

import os
import signal
import time
from contextlib import contextmanager

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.identity import key_of
from skinglow_blender.live import shape_answers, shape_update
from skinglow_blender.session import SESSION
from skinglow_blender.table import shape_light

from inside.scenes import camera_above, depsgraph, render_settings
from inside.shape_scenes import assert_through, lobe, shape_skin, shown, sun, turn


@contextmanager
def in_a_window():
    """Updates wait for nothing."""
    waits = shape_update.is_synchronous
    shape_update.is_synchronous = lambda mode: mode == "RENDER"
    try:
        yield
    finally:
        shape_update.is_synchronous = waits
        shape_answers.stop()


def report(obj):
    return sb.state_of(obj, depsgraph()).shape


def wait_for(obj, *kinds, seconds=60.0):
    """What is shown until the thread has nothing to do, in order."""
    seen, end = [], time.monotonic() + seconds
    while not seen or SESSION.shape_worker.is_busy:
        shape_answers.take_answers()
        kind = report(obj).shown
        if kind not in seen[-1:]:
            seen.append(kind)
        assert time.monotonic() < end, seen
        time.sleep(0.002)
    if kinds:
        assert seen[-1] == kinds[-1] and set(seen) <= set(kinds), (
            seen,
            kinds,
            shape_update.state_of(key_of(obj), "VIEWPORT").fault,
        )
    return seen


def pixels(obj):
    return shown(obj, depsgraph(), int(obj.data["skinglow_tiles"]["rows"])).copy()


def check_the_table_stands_in_and_then_light_is_solved(_work):
    key = sun()
    obj = lobe()
    with in_a_window():
        shape_skin(obj)
        first = pixels(obj)
        assert report(obj).shown == "TABLE" and first[..., :3].max() > 0.0
        wait_for(obj, "TABLE", "COARSE", "FULL")
        assert_through(obj)
        state = report(obj)
        assert 0 < state.ready_parts <= state.parts and state.cells > 0 and state.bytes > 0
        assert state.milliseconds is None and state.first_seconds > 0.0
        assert len(state.error) == 3 and state.progress is None
        # A moved light: what was shown stays until there is something better.
        before = pixels(obj)
        turn(key, (-0.6, 0.3, 1.0))
        depsgraph()
        np.testing.assert_array_equal(pixels(obj), before)
        wait_for(obj, "COARSE", "FULL")
        assert_through(obj)
        assert 0.0 < report(obj).milliseconds < 1000.0 * report(obj).first_seconds


def check_a_drag_before_the_first_full_answer_is_not_what_the_first_light_took(_work):
    sun()
    obj = lobe()
    shape_skin(obj)
    depsgraph()
    state = shape_update.state_of(key_of(obj), "VIEWPORT")
    body = shape_light.Body(state.key, state.tiles, 1)
    shape = body.shape()

    def solved(full):
        before = body.first_seconds
        answer = shape_light._solved(shape, body, state.light, lambda _fraction: True, full=full)
        return answer.seconds is None, body.first_seconds > before

    # The first coarse answer and the first full one make the body ready; no other does.
    assert [solved(full) for full in (False, False, True, True)] == [(True, True), (False, False)] * 2


def check_colors_and_sliders_show_at_once(_work):
    key = sun()
    obj = lobe()
    with in_a_window():
        shape_skin(obj)
        wait_for(obj)
        key.data.color, key.data.energy = (1.0, 0.25, 0.1), 6.0
        assert_through(obj, 0.01)
        assert report(obj).shown == "COARSE" and SESSION.shape_worker.is_busy
        key.data.energy = 3.0
        assert_through(obj, 0.01)
        wait_for(obj, "COARSE", "FULL")
        assert_through(obj)
        before = pixels(obj)
        obj.skinglow.blood_fraction = 0.02
        depsgraph()
        at_once = pixels(obj)
        wait_for(obj, "COARSE", "FULL")
        solved = pixels(obj)
        difference = np.abs(solved - at_once)[..., :3].mean()
        assert difference < 0.3 * np.abs(solved - before)[..., :3].mean()


def check_the_newest_request_wins_and_faults_are_told(_work):
    key = sun()
    obj = lobe()
    with in_a_window():
        shape_skin(obj)
        for i in range(6):
            turn(key, (0.1 * i, 0.3, 1.0))
            depsgraph()
        wait_for(obj)
        assert_through(obj)
        # Undo and what else replaces all data: nothing is computed again.
        answer = SESSION.shapes[key_of(obj), "VIEWPORT"].answer
        before = pixels(obj)
        SESSION.forget()
        sb.update(depsgraph())
        assert SESSION.shapes[key_of(obj), "VIEWPORT"].answer is answer and not SESSION.shape_worker.is_busy
        np.testing.assert_array_equal(pixels(obj), before)
        # A render waits for its own light, and leaves that of the viewport.
        sb.remove_skin(obj)
        assert not SESSION.shapes and not SESSION.shape_worker.is_busy


def check_ctrl_c_ends_what_a_render_waits_for(work):
    """The signal goes on to whom it was for: a function here, or else Blender's own, which cancels the render."""
    key = sun()
    obj = lobe(levels=2)
    shape_skin(obj)
    camera_above()
    scene = render_settings(8, 8)
    scene.render.filepath = str(work / "canceled.exr")
    heard, asked = [], []

    def press(_fraction):
        asked.append(SESSION.interrupted)
        if len(asked) == 1:
            os.kill(os.getpid(), signal.SIGINT)
        return go_on(_fraction)

    go_on = shape_update.may_go_on
    of_blender = signal.getsignal(signal.SIGINT) is None
    if not of_blender:
        before = signal.signal(signal.SIGINT, lambda number, _frame: heard.append(number))
    shape_update.may_go_on = press
    try:
        with in_a_window():
            turn(key, (-0.6, 0.3, 1.0))
            bpy.ops.render.render(write_still=True)
        in_render, told = list(asked), shape_update.state_of(key_of(obj), "RENDER").fault
        asked.clear()
        if of_blender:
            assert not SESSION.faults, "a canceled render is no fault"
        key.keyframe_insert("rotation_euler", frame=1)
        turn(key, (-0.7, 0.3, 1.0))
        key.keyframe_insert("rotation_euler", frame=2)
        shape_update.may_go_on = go_on
        scene.frame_set(1)
        shape_update.may_go_on = press
        try:
            sb.render_batch(work / "batch", frames=2, scene=scene)
            raise AssertionError("the batch went on")
        except KeyboardInterrupt:
            pass
    finally:
        shape_update.may_go_on = go_on
        if not of_blender:
            handler = signal.signal(signal.SIGINT, before)
    assert in_render == asked == [False], "it went on"
    assert "canceled" in told and not list((work / "batch").glob("**/*.exr"))
    if of_blender:
        assert not (work / "canceled.exr").exists()
    else:
        assert heard == 2 * [signal.SIGINT] and handler.__name__ == "<lambda>"
    # Nothing is kept of it: the next render waits for the whole.
    bpy.ops.render.render(write_still=True)
    assert (work / "canceled.exr").exists()
    assert shape_update.state_of(key_of(obj), "RENDER").is_full and not SESSION.faults
