"""Takes the first pictures of docs/blender.md: a full Blender in a virtual display, a click on the panel's button.

Needs a full Blender, Xvfb, the core as a folder, made by scripts/build, and the demo's head, which is downloaded; from
Blender 4.2 on also scrot.
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import tempfile
from pathlib import Path

from studies.demo.head_source import find
from studies.display import virtual_display
from studies.paths import IMAGES, PROJECT, SITE
from studies.progress import Progress, StudyError

SCREEN = (1440, 900)
#: The scene before the click, the panel after it, and the ear up close.
PICTURES = ("guide_select.png", "panel.png", "guide_ear.png")


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m studies panel", description=__doc__)
    options = 'with its options: "blender --gpu-backend opengl" where there is no GPU'
    parser.add_argument("blender", nargs="?", default="blender", help=options)
    parser.add_argument("folder", nargs="?", type=Path, default=IMAGES, help="(default %(default)s)")
    options = parser.parse_args(arguments)
    head = find(None, None, Progress(PROJECT / "build" / "panel.log"))
    pictures = [options.folder.resolve() / name for name in PICTURES]
    with tempfile.TemporaryDirectory() as profile, virtual_display(*SCREEN) as display:
        command = [*shlex.split(options.blender), "--factory-startup"]
        command += ["--enable-event-simulate", "--window-geometry", "0", "0", *map(str, SCREEN)]
        command += ["-P", Path(__file__).with_name("window.py"), "--", head.mesh, SITE, *pictures]
        environment = {**os.environ, "BLENDER_USER_RESOURCES": profile, "DISPLAY": display}
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, check=False
        )
    if "STEPS DONE" not in done.stdout or "Traceback" in done.stdout:
        raise StudyError(f"the pictures were not taken:\n{done.stdout}")
    print(*pictures, sep="\n")
