"""Thickness in a real window: numbers and histogram in the panel, colors and legend over the skin."""

import json
import os
import subprocess

import matplotlib.image
import numpy as np
import pytest
from hosts import ADDON_FOLDER, HERE, host_named

PICTURES = HERE.parents[1] / "scripts" / "panel_pictures"
SECONDS = 400


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, np.ndarray], dict]:
    """The pictures by name, (height, width, 3), and the facts that the steps told."""
    host = host_named("3.4")
    host.require()
    folder = tmp_path_factory.mktemp("thickness")
    command = ["xvfb-run", "-a", "-s", "-screen 0 1200x800x24", host.path, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1200", "800"]
    command += ["-P", str(HERE / "window" / "thickness_steps.py"), "--", str(folder / "facts.jsonl")]
    command += [str(PICTURES), str(ADDON_FOLDER), os.environ.get("SKINGLOW_SITE_311", "")]
    done = subprocess.run(
        ["timeout", "--kill-after=10", str(SECONDS), *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=host.environment(folder),
        cwd=folder,
        check=False,
    )
    assert "STEPS DONE" in done.stdout and "Traceback" not in done.stdout, done.stdout[-6000:]
    facts = [json.loads(line) for line in (folder / "facts.jsonl").read_text().splitlines()]
    pictures = {path.stem: matplotlib.image.imread(path)[:, :, :3] for path in folder.glob("*.png")}
    return pictures, {fact["fact"]: fact["value"] for fact in facts}


def view(picture: np.ndarray) -> np.ndarray:
    """The part of the window that shows the head, without panels and legend."""
    return picture[100:700, 250:760]


def test_colors_cover_the_skin_while_they_are_on(window: tuple) -> None:
    pictures, _facts = window
    # The back of the head, which is thick: violet in place of Blender's own gray.
    back = {name: view(picture)[180:230, 200:300] for name, picture in pictures.items()}
    assert back["heat_map"].mean() < 0.2 and np.ptp(back["heat_map"].mean(axis=(0, 1))) > 0.1
    for name in ("plain", "nothing_selected", "off", "removed"):
        assert back[name].mean() > 0.3 and np.ptp(back[name].mean(axis=(0, 1))) < 0.05, name
    # And the ear, which is thin.
    changed = np.abs(view(pictures["heat_map"]) - view(pictures["plain"])).max(axis=2) > 0.1
    orange = (view(pictures["heat_map"])[:, :, 0] > 0.8) & (view(pictures["heat_map"])[:, :, 2] < 0.6)
    assert (changed & orange).sum() > 2000


def test_colors_follow_the_shape(window: tuple) -> None:
    pictures, _facts = window
    assert np.abs(view(pictures["reshaped"]) - view(pictures["heat_map"])).mean() > 0.02


def test_legend_shows_all_colors(window: tuple) -> None:
    pictures, _facts = window
    # Its bar, from thick above to thin below.
    before, bar = (pictures[name][490:660, 88:101] for name in ("plain", "heat_map"))
    assert np.abs(bar - before).mean() > 0.2
    brightness = bar[2:-2].mean(axis=(1, 2))
    assert brightness[-1] > brightness[0] + 0.4 and (np.diff(brightness) > -0.02).all()


def test_nothing_is_computed_for_a_redraw_and_nothing_left(window: tuple) -> None:
    _pictures, facts = window
    assert facts["kept between redraws"] == facts["after a redraw"]
    assert facts["off"] == [0, 0] and facts["removed"] == [0, False]
    limit, low, median, high, above = facts["summary"]
    assert limit == 12.0 and 0.0 < low < median < high and 0.5 < above < 1.0
