"""The panel in a real window: Debian's Blender under Xvfb, with clicks and keys, drawn and looked at."""

import numpy as np
import pytest
from window_runs import Window, run_in_window


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Window:
    folder = tmp_path_factory.mktemp("window")
    return run_in_window("panel_steps", folder, str(folder / "panel.png"))


def test_nothing_went_wrong_while_drawing(window: Window) -> None:
    window.require_done()


def test_the_button_makes_a_skin_and_undo_takes_it_back(window: Window) -> None:
    low, high = window["the button made a skin"]
    assert 0.0 < low < high < 100.0
    assert window["undo left"] == [False, 0, 0]
    assert window["redo shows the same table"] is True


def test_the_list_is_sorted_and_says_why(window: Window) -> None:
    rows = window["rows"]
    shares = [share for _name, share, _reason in rows]
    assert len(rows) == 7 and shares == sorted(shares, reverse=True) and abs(sum(shares) - 1.0) < 0.01
    reasons = {name: reason for name, _share, reason in rows if reason}
    assert reasons["Hidden"] == "disabled in viewports" and "zero power" in reasons["Switched off"]


def test_redraws_compute_nothing(window: Window) -> None:
    drawn, computed, looks = window["redraws, computed, looks"]
    assert drawn >= 5
    assert (computed, looks) == (0, 0)


def test_escape_cancels_measuring_and_changes_nothing(window: Window) -> None:
    assert window["bake began as"] == ["RUNNING_MODAL"]
    assert window["canceling kept the thickness"] is True
    assert window["rays after canceling and undo"] == 64


def test_measuring_in_the_window_can_be_undone(window: Window) -> None:
    low, high = window["measured in the window"]
    assert [low, high] == pytest.approx(window["the button made a skin"])
    assert window["measuring undone and redone"] is True


def test_the_lookup_follows_a_moved_light(window: Window) -> None:
    assert window["the lookup followed a moved lamp"] is True


def test_a_fault_stands_in_the_panel(window: Window) -> None:
    (fault,) = window["faults shown"]
    assert "no image is selected" in fault


def test_subsurface_that_counts_twice_stands_in_the_panel(window: Window) -> None:
    hint, *others = window["hints"]
    assert "scatters light below its surface" in hint and not others


def test_the_pictures_show_something(window: Window) -> None:
    pictures = window.pictures
    assert set(pictures) == {"panel", "panel_before", "panel_measuring", "panel_material"}
    for name, picture in pictures.items():
        assert picture.std() > 0.05, f"{name}.png is blank"
        assert len(np.unique((picture * 255).astype(np.uint8).reshape(-1, 3), axis=0)) > 500, f"{name}.png is blank"
    # The panel without a skin is short; with one, its parts cover the sidebar's column.
    assert np.abs(pictures["panel"] - pictures["panel_before"]).mean() > 0.005
