"""Freezing in a real window: Debian's Blender under Xvfb; Esc, undo, redo, and the panel's pictures."""

import json
import os
import subprocess
from pathlib import Path

import matplotlib.image
import pytest
from hosts import ADDON_FOLDER, HERE, host_named

PICTURES = HERE.parents[1] / "scripts" / "panel_pictures"
SECONDS = 400


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict, str]:
    """The folder of pictures, the facts that the steps told, and what Blender printed."""
    host = host_named("3.4")
    host.require()
    folder = tmp_path_factory.mktemp("freeze")
    command = ["xvfb-run", "-a", "-s", "-screen 0 1200x800x24", host.path, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1200", "800"]
    command += ["-P", str(HERE / "window" / "freeze_steps.py"), "--", str(folder / "facts.jsonl")]
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
    return folder, {fact["fact"]: fact["value"] for fact in facts}, done.stdout


def test_escape_leaves_nothing(window: tuple[Path, dict, str]) -> None:
    _folder, facts, _output = window
    assert facts["began as"] == ["RUNNING_MODAL"]
    assert facts["after Esc"] == [False, [], 7, "BLENDER_EEVEE"]


def test_frozen_undone_redone_and_live_again(window: tuple[Path, dict, str]) -> None:
    folder, facts, output = window
    assert facts["frozen"] == [True, ["Ball"], 7, "BLENDER_EEVEE"]
    assert "Ball: frames 1 to 40 frozen to" in output
    assert len(list((folder / "skinglow_frozen" / "Ball").glob("light_*.exr"))) == 40
    (fault,) = facts["health"]
    assert "changed after it was frozen" in fault
    assert facts["unfrozen"] is False


def test_the_panel_shows_each_state(window: tuple[Path, dict, str]) -> None:
    pictures = {path.stem: matplotlib.image.imread(path)[:, :, :3] for path in window[0].glob("*.png")}
    assert set(pictures) == {"live", "frozen", "changed"}
    # The sidebar alone, at the right of the view.
    panels = [picture[80:560, 770:960] for picture in pictures.values()]
    assert all(panel.std() > 0.05 for panel in panels)
    assert all(abs(a - b).mean() > 0.005 for a, b in zip(panels, panels[1:], strict=False))
