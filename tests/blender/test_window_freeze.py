"""Freezing in a real window: Debian's Blender under Xvfb; Esc, undo, redo, and the panel's pictures."""

import pytest
from window_runs import Window, run_in_window


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Window:
    run = run_in_window("freeze_steps", tmp_path_factory.mktemp("freeze"))
    run.require_done()
    return run


def test_escape_leaves_nothing(window: Window) -> None:
    assert window["began as"] == ["RUNNING_MODAL"]
    assert window["after Esc"] == [False, [], 7, "BLENDER_EEVEE"]


def test_frozen_undone_redone_and_live_again(window: Window) -> None:
    assert window["frozen"] == [True, ["Ball"], 7, "BLENDER_EEVEE"]
    assert "Ball: frames 1 to 40 frozen to" in window.output
    assert len(list((window.folder / "skinglow_frozen" / "Ball").glob("light_*.exr"))) == 40
    (fault,) = window["health"]
    assert "changed after it was frozen" in fault
    assert window["unfrozen"] is False


def test_the_panel_shows_each_state(window: Window) -> None:
    pictures = window.pictures
    assert set(pictures) == {"live", "frozen", "changed"}
    # The sidebar alone, at the right of the view.
    panels = [picture[80:560, 770:960] for picture in pictures.values()]
    assert all(panel.std() > 0.05 for panel in panels)
    assert all(abs(a - b).mean() > 0.005 for a, b in zip(panels, panels[1:], strict=False))
