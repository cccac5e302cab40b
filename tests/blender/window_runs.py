"""Runs steps in the window of Debian's Blender under Xvfb, with real clicks and keys."""

import json
import os
import subprocess
from pathlib import Path

import matplotlib.image
import numpy as np
from hosts import ADDON_FOLDER, HERE, host_named

from studies.display import virtual_display

#: Seconds for a whole run; software OpenGL on a busy machine is slow.
SECONDS = 540
#: Width and height of the screen and of Blender's window in it, pixels.
SCREEN = (1200, 800)


class Window:
    """What the steps found, what Blender printed, and the folder of pictures."""

    def __init__(self, folder: Path, output: str) -> None:
        self.folder = folder
        self.output = output
        lines = (folder / "facts.jsonl").read_text().splitlines() if (folder / "facts.jsonl").exists() else []
        self.facts = {fact["fact"]: fact["value"] for fact in map(json.loads, lines)}

    def __getitem__(self, name: str):
        assert name in self.facts, f"the steps never came to '{name}':\n{self.output[-4000:]}"
        return self.facts[name]

    @property
    def pictures(self) -> dict[str, np.ndarray]:
        """The pictures by name, (height, width, 3)."""
        return {path.stem: matplotlib.image.imread(path)[:, :, :3] for path in self.folder.glob("*.png")}

    def require_done(self) -> None:
        """Fails with what Blender printed if the steps did not come to their end."""
        assert "Traceback" not in self.output, self.output[-6000:]
        assert "STEPS DONE" in self.output, self.output[-6000:]


def run_in_window(steps: str, folder: Path, *arguments: str) -> Window:
    """Runs `window/<steps>.py` with the file of facts, these arguments, and the folders that all steps need."""
    host = host_named("3.4")
    host.require()
    width, height = SCREEN
    command = [host.path, "--factory-startup", "--enable-event-simulate"]
    command += ["--window-geometry", "0", "0", str(width), str(height)]
    command += ["-P", str(HERE / "window" / f"{steps}.py"), "--", str(folder / "facts.jsonl"), *arguments]
    command += [str(ADDON_FOLDER), os.environ.get("SKINGLOW_SITE_311", "")]
    log = folder / "output.txt"
    with virtual_display(width, height) as display, log.open("w") as output:
        # Blender's own processes too are ended after that time.
        subprocess.run(
            ["timeout", "--kill-after=10", str(SECONDS), *command],
            stdout=output,
            stderr=subprocess.STDOUT,
            env={**host.environment(folder), "DISPLAY": display},
            cwd=folder,
            check=False,
        )
    return Window(folder, log.read_text())
