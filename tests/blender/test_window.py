"""The panel in a real window: Debian's Blender under Xvfb, with clicks and keys, drawn and looked at."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from hosts import ADDON_FOLDER, HERE, host_named

PICTURES = HERE.parents[1] / "scripts" / "panel_pictures"
#: Seconds for the whole run; software OpenGL on a busy machine is slow.
SECONDS = 540


class Window:
    """What the steps found, what Blender printed, and the pictures' folder."""

    def __init__(self, folder: Path, output: str) -> None:
        self.folder = folder
        self.output = output
        lines = (folder / "facts.jsonl").read_text().splitlines() if (folder / "facts.jsonl").exists() else []
        self.facts = {fact["fact"]: fact["value"] for fact in map(json.loads, lines)}

    def __getitem__(self, name: str):
        assert name in self.facts, f"the steps never came to '{name}':\n{self.output[-4000:]}"
        return self.facts[name]


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Window:
    host = host_named("3.4")
    assert host.path, f"Blender 3.4 is not there: {host.variable} does not say where it is"
    assert shutil.which("xvfb-run"), "xvfb-run is not there: install xvfb and xauth (scripts/setup --tests does)"
    folder = tmp_path_factory.mktemp("window")
    command = ["xvfb-run", "-a", "-s", "-screen 0 1200x800x24", host.path, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1200", "800"]
    command += ["-P", str(HERE / "window" / "panel_steps.py"), "--", str(folder / "facts.jsonl")]
    command += [str(folder / "panel.png"), str(PICTURES), str(ADDON_FOLDER), os.environ.get("SKINGLOW_SITE_311", "")]
    log = folder / "output.txt"
    with log.open("w") as output:
        # What ends it after that time ends Xvfb too.
        subprocess.run(
            ["timeout", "--kill-after=10", str(SECONDS), *command],
            stdout=output,
            stderr=subprocess.STDOUT,
            env=host.environment(folder),
            cwd=folder,
            check=False,
        )
    return Window(folder, log.read_text())


def test_nothing_went_wrong_while_drawing(window: Window) -> None:
    assert "Traceback" not in window.output, window.output[-6000:]
    assert "STEPS DONE" in window.output, window.output[-6000:]


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
    pictures = {p.stem: matplotlib.image.imread(p)[:, :, :3] for p in window.folder.glob("*.png")}
    assert set(pictures) == {"panel", "panel_before", "panel_measuring", "panel_material"}
    for name, picture in pictures.items():
        assert picture.std() > 0.05, f"{name}.png is blank"
        assert len(np.unique((picture * 255).astype(np.uint8).reshape(-1, 3), axis=0)) > 500, f"{name}.png is blank"
    # The panel without a skin is short; with one, its parts cover the sidebar's column.
    assert np.abs(pictures["panel"] - pictures["panel_before"]).mean() > 0.005
