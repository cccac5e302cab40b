"""Light through the shape in a real window: what stands in, a light in motion, undo, and the thread's end."""

import numpy as np
import pytest
from window_runs import Window, run_in_window


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Window:
    run = run_in_window("shape_steps", tmp_path_factory.mktemp("shape"))
    run.require_done()
    return run


def test_the_button_begins_with_the_table_and_light_is_solved(window: Window) -> None:
    assert window["lighting"] == "SHAPE"
    first, last, _seconds = window["first"]
    assert (first, last) == ("TABLE", "FULL")
    parts, ready, cells, size, channels = window["report"]
    assert 0 < ready <= parts and cells > 0 and size > 0 and channels == 3


def test_a_light_in_motion_is_solved_coarsely_and_then_fully(window: Window) -> None:
    assert "COARSE" in window["moved"] and window["moved"][-1] == "FULL" and "TABLE" not in window["moved"]
    assert window["faults"] == []


def test_the_pictures_differ(window: Window) -> None:
    pictures = window.pictures
    assert set(pictures) == {"solved", "moved"}
    assert all(picture.std() > 0.05 for picture in pictures.values())
    assert np.abs(pictures["solved"] - pictures["moved"]).mean() > 0.0


def test_esc_ends_what_a_render_waits_for(window: Window) -> None:
    waiting, longest, fault = window["canceled"]
    assert waiting == 0 and "canceled" in fault
    assert longest < 20.0


def test_the_thread_ends_with_the_add_on(window: Window) -> None:
    assert window["after"] == [True, 0]
