"""Thickness in a real window: numbers and histogram in the panel, colors and legend over the skin."""

import numpy as np
import pytest
from window_runs import Window, run_in_window


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Window:
    run = run_in_window("thickness_steps", tmp_path_factory.mktemp("thickness"))
    run.require_done()
    return run


def view(picture: np.ndarray) -> np.ndarray:
    """The part of the window that shows the head, without panels and legend."""
    return picture[100:700, 250:760]


def test_colors_cover_the_skin_while_they_are_on(window: Window) -> None:
    pictures = window.pictures
    # The back of the head, which is thick: violet in place of Blender's own gray.
    back = {name: view(picture)[180:230, 200:300] for name, picture in pictures.items()}
    assert back["heat_map"].mean() < 0.2 and np.ptp(back["heat_map"].mean(axis=(0, 1))) > 0.1
    for name in ("plain", "nothing_selected", "off", "removed"):
        assert back[name].mean() > 0.3 and np.ptp(back[name].mean(axis=(0, 1))) < 0.05, name
    # And the ear, which is thin.
    changed = np.abs(view(pictures["heat_map"]) - view(pictures["plain"])).max(axis=2) > 0.1
    orange = (view(pictures["heat_map"])[:, :, 0] > 0.8) & (view(pictures["heat_map"])[:, :, 2] < 0.6)
    assert (changed & orange).sum() > 2000


def test_colors_are_an_overlay_of_what_a_view_shows(window: Window) -> None:
    """Turned off with all overlays, as for a picture of the view, and not over what a local view leaves out."""
    for name in ("no_overlays", "local_view"):
        picture = view(window.pictures[name])
        assert np.ptp(picture, axis=2).mean() < 0.02, name


def test_measuring_leaves_no_word_behind(window: Window) -> None:
    """In the workspace that it was begun in; and the buttons work after the add-on was off meanwhile."""
    assert window["workspaces"] == [2, None] and window["after measuring"] == [None, None]
    assert window["turned off"] == [True, True, None, None] and window["window closed"]


def test_colors_follow_the_shape(window: Window) -> None:
    pictures = window.pictures
    assert np.abs(view(pictures["reshaped"]) - view(pictures["heat_map"])).mean() > 0.02


def test_legend_shows_all_colors(window: Window) -> None:
    pictures = window.pictures
    # Its bar, from thick above to thin below.
    before, bar = (pictures[name][490:660, 88:101] for name in ("plain", "heat_map"))
    assert np.abs(bar - before).mean() > 0.2
    brightness = bar[2:-2].mean(axis=(1, 2))
    assert brightness[-1] > brightness[0] + 0.4 and (np.diff(brightness) > -0.02).all()


def test_nothing_is_computed_for_a_redraw_and_nothing_left(window: Window) -> None:
    assert window["kept between redraws"] == window["after a redraw"]
    assert window["off"] == [0, 0] and window["removed"] == [0, False]
    limit, low, median, high, above = window["summary"]
    assert limit == 12.0 and 0.0 < low < median < high and 0.5 < above < 1.0
