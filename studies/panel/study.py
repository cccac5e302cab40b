"""Takes the pictures of docs/blender.md that show a window: a full Blender in a virtual display, a click on the panel's
button.

Needs a full Blender, Xvfb, the core as a folder, made by scripts/build, and the demo's person, which is downloaded;
from Blender 4.2 on also scrot.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path

from studies.display import virtual_display
from studies.heads import sources
from studies.paths import IMAGES, PROJECT, SITE
from studies.progress import Progress, StudyError

SCREEN = (1440, 900)
#: By subject of window.py: the scene before the click, the panel after it, the ear up close; and thickness.
PICTURES = {"guide": ("guide_select.png", "panel.png", "guide_ear.png"), "thickness": ("thickness.png",)}


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m studies panel", description=__doc__)
    about = 'with its options: "blender --gpu-backend opengl" where there is no GPU'
    parser.add_argument("blender", nargs="?", default="blender", help=about)
    parser.add_argument("folder", nargs="?", type=Path, default=IMAGES, help="(default %(default)s)")
    options = parser.parse_args(arguments)
    blender = shlex.split(options.blender)
    head = sources.head_job(None, Progress(PROJECT / "build" / "panel.log"))
    with tempfile.TemporaryDirectory() as taken:
        for subject, names in PICTURES.items():
            take(blender, [subject, json.dumps(head), str(SITE), *(str(Path(taken, name)) for name in names)])
            for name in names:
                print(shutil.copy(Path(taken, name), options.folder.resolve() / name))


def take(blender: list[str], arguments: list[str]) -> None:
    """Runs window.py in a window of its own; raises StudyError where the pictures were not taken."""
    with tempfile.TemporaryDirectory() as profile, virtual_display(*SCREEN) as display:
        command = [*blender, "--factory-startup", "--python-exit-code", "3"]  # ends where a step fails at once
        command += ["--enable-event-simulate", "--window-geometry", "0", "0", *map(str, SCREEN)]
        command += ["-P", str(Path(__file__).with_name("window.py")), "--", *arguments]
        environment = {**os.environ, "BLENDER_USER_RESOURCES": profile, "DISPLAY": display}
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, check=False
        )
    if "STEPS DONE" not in done.stdout or "Traceback" in done.stdout:
        raise StudyError(f"the pictures were not taken:\n{done.stdout}")
