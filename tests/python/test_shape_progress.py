"""Long calls of skinglow.Shape and LitShape: progress, stopping, the interpreter's lock."""

import threading
import time

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

LIGHTS = [
    sg.Light("POINT", position=(0.0, 5.0, 60.0), power=1000.0, radius=3.0, color=(1.0, 0.5, 0.2)),
    sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0, sun_angle=0.01),
]
BODY = bodies.lobe(levels=4)
IRRADIANCE = np.arange(float(len(BODY[0])))
# Each solves, on a shape that nothing is prepared of.
CALLS = {
    "exitance": lambda shape, progress: shape.exitance(IRRADIANCE, progress=progress),
    "light": lambda shape, progress: shape.light(LIGHTS, progress=progress).exitance,
    "recolor": lambda shape, progress: shape.light(3 * LIGHTS).recolor(np.eye(6)[:, :3], progress=progress),
}


class StoppedByHostError(Exception):
    pass


def stop_at(call):
    """A progress function that raises when it is called for the `call`th time."""
    seen = []

    def progress(done):
        seen.append(done)
        if len(seen) == call:
            raise StoppedByHostError(f"at {done}")
        return True

    return progress


@pytest.fixture
def shape():
    return sg.Shape(*BODY, sg.Tissue())


@pytest.mark.parametrize("name", CALLS)
def test_progress_ascends_to_one_on_this_thread(shape, name):
    seen = []

    def progress(done):
        assert threading.current_thread() is threading.main_thread()
        seen.append(done)
        return True

    CALLS[name](shape, progress)
    assert seen == sorted(seen)
    assert (seen[0], seen[-1]) == (0.0, 1.0)


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.parametrize("call", [1, 2])  # the first and, on a fast machine, the last
def test_what_progress_raises_ends_the_call_and_the_shape_goes_on(shape, name, call):
    with pytest.raises(StoppedByHostError):
        CALLS[name](shape, stop_at(call))
    expected = CALLS[name](sg.Shape(*BODY, sg.Tissue()), None)
    np.testing.assert_array_equal(CALLS[name](shape, None), expected)


@pytest.mark.parametrize("name", CALLS)
def test_progress_cancels(shape, name):
    with pytest.raises(RuntimeError, match="cancelled by the progress function"):
        CALLS[name](shape, lambda done: False)
    assert CALLS[name](shape, None).max() > 0.0


def test_a_shape_is_not_made_where_progress_raises():
    with pytest.raises(StoppedByHostError):
        sg.Shape(*BODY, sg.Tissue(), progress=stop_at(1))


def test_other_threads_of_python_run_meanwhile(shape):
    """A thread that never waits is never held up for most of the call: the interpreter's lock is given up."""
    ticks, over = [time.perf_counter()], threading.Event()

    def tick():
        while not over.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    ticking = threading.Thread(target=tick)
    ticking.start()
    start = time.perf_counter()
    shape.exitance(IRRADIANCE)
    seconds = time.perf_counter() - start
    over.set()
    ticking.join()
    assert np.diff(ticks).max() < 0.7 * seconds


def test_two_threads_may_ask_one_shape_and_one_of_them_stop(shape):
    results = []
    other = threading.Thread(target=lambda: results.append(shape.exitance(IRRADIANCE)))
    other.start()
    with pytest.raises(StoppedByHostError):
        shape.exitance(IRRADIANCE, progress=stop_at(2))
    other.join()
    np.testing.assert_array_equal(results[0], shape.exitance(IRRADIANCE))
